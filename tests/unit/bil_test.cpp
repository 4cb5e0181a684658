// SPDX-License-Identifier: Apache-2.0

#include "formats/bil/bil.h"

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "formats/bil/bil_header.h"
#include "scratch.h"

namespace tex {
namespace {

class Bil : public testing::Test, protected Scratch {
protected:
    [[nodiscard]] Result<Image> read(const std::string& name) const { return read_image(path(name)); }
    // Reads a grid of 2 x 2 with this header besides its extent.
    [[nodiscard]] Result<Image> read(const std::string& header, const std::string& bytes) const {
        write("h.hdr", "NROWS 2\nNCOLS 2\n" + header);
        write("h.bil", bytes);
        return read("h.bil");
    }
    [[nodiscard]] std::string reason_of(const std::string& header, const std::string& bytes) const {
        const auto image = read(header, bytes);
        return image ? "read"
                     : std::filesystem::path(image.error().file).filename().string() + ": " + image.error().reason;
    }
};

// The texels as "a b c d".
std::string texels_of(const Result<Image>& image) {
    if (!image) return image.error().reason;
    std::string text;
    for (int k = 0; k < 4; ++k) {
        std::string number = std::to_string(image->planes[0].at(k % 2, k / 2));
        number.erase(number.find_last_not_of('0') + 1);
        text += (k == 0 ? "" : " ") + number;
    }
    return text;
}

TEST_F(Bil, TheHeaderSaysWhereTheCellsAre) {
    const auto image = read("ULXMAP 7.5\nULYMAP 46.5\nXDIM 0.01\nYDIM 0.02\nPIXELTYPE SIGNEDINT", "abcd");
    ASSERT_TRUE(image && image->ground) << image->ground_remark;
    EXPECT_EQ(image->ground->unit, GroundUnit::degree);
    EXPECT_EQ(image->ground->width, 0.01);
    EXPECT_EQ(image->ground->height, 0.02);
    EXPECT_EQ(image->ground->north, 46.5);
    write("h.prj", "Projection UTM\nUnits METERS\n");
    EXPECT_EQ(read("XDIM 30\nYDIM 20", "abcd")->ground->height, 20.0);
    // GridFloat has the words of ASCII grids.
    write("h.flt", std::string(16, '\0'));
    write("h.hdr", "ncols 2\nnrows 2\nxllcorner 500000\nyllcorner 100\ncellsize 5\nbyteorder LSBFIRST\n");
    EXPECT_EQ(read("h.flt")->ground->width, 5.0);
    EXPECT_FALSE(read("", "abcd")->ground);
    EXPECT_EQ(read("", "abcd")->ground_remark, "");
}

TEST_F(Bil, ReadsEveryTypeAndOrder) {
    EXPECT_EQ(texels_of(read("", std::string("\0\1\x7f\xff", 4))), "0. 1. 127. 255.");
    EXPECT_EQ(texels_of(read("PIXELTYPE SIGNEDINT", std::string("\0\1\x80\xff", 4))), "0. 1. -128. -1.");
    const std::string words("\1\2\3\4\xff\xfe\x80\0", 8);
    EXPECT_EQ(texels_of(read("NBITS 16\r\nBYTEORDER M", words)), "258. 772. 65534. 32768.");
    EXPECT_EQ(texels_of(read("nbits 16\nByteOrder I\nlayout BIL", words)), "513. 1027. 65279. 128.");
    EXPECT_EQ(texels_of(read("NBITS 16\nPIXELTYPE SIGNEDINT\nBYTEORDER M", words)), "258. 772. -2. -32768.");
    const std::string longs("\0\0\1\0\0\0\0\2\xff\xff\xff\xff\x7f\0\0\0", 16);
    EXPECT_EQ(texels_of(read("NBITS 32\nBYTEORDER M", longs)), "256. 2. 4294967296. 2130706432.");
    EXPECT_EQ(texels_of(read("NBITS 32\nBYTEORDER M\nPIXELTYPE SIGNEDINT", longs)), "256. 2. -1. 2130706432.");
    const std::string floats("\x3f\x80\0\0\xc1\x20\0\0\0\0\0\0\x44\x7a\0\0", 16);
    EXPECT_EQ(texels_of(read("NBITS 32\nBYTEORDER M\nPIXELTYPE FLOAT", floats)), "1. -10. 0. 1000.");
}

// GDAL 3.6.2 (EHdr) reads the same, as UInt16 and Float32; with NBITS it reads what that says.
TEST_F(Bil, TheSizeTellsTheBitsIfTheHeaderDoesNot) {
    const std::string words("\1\2\3\4\xff\xfe\x80\0", 8);
    const auto image = read("BYTEORDER M", words);
    EXPECT_EQ(texels_of(image), "258. 772. 65534. 32768.");
    EXPECT_EQ(image->remark, "its header has no nbits, and its size means 16 bits");
    EXPECT_EQ(texels_of(read("BYTEORDER M\nPIXELTYPE SIGNEDINT", words)), "258. 772. -2. -32768.");
    EXPECT_EQ(texels_of(read("BYTEORDER M", words + "abc")), "258. 772. 65534. 32768.") << "a few bytes more";
    EXPECT_EQ(texels_of(read("BYTEORDER M\nNBITS 8", words)), "1. 2. 3. 4.");
    const std::string floats("\x3f\x80\0\0\xc1\x20\0\0\0\0\0\0\x44\x7a\0\0", 16);
    EXPECT_EQ(texels_of(read("BYTEORDER M", floats)), "1. -10. 0. 1000.");
}

// GDAL 3.6.2 and 3.13.3 (EHdr) read 258 and 772 from these bytes, and 2.3879393e-38 from the floats.
TEST_F(Bil, TheHighByteIsFirstIfTheHeaderHasNoOrder) {
    const std::string bytes("\1\2\3\4\5\6\7\10\11\12\13\14\15\16\17\20", 16);
    const auto image = read("NBITS 16", bytes.substr(0, 8));
    EXPECT_EQ(texels_of(image), "258. 772. 1286. 1800.");
    EXPECT_EQ(
        image->remark,
        "its header has no byteorder, so the high byte is read first; \"byteorder I\" there means the low byte first");
    EXPECT_EQ(read("NBITS 32\nPIXELTYPE FLOAT", bytes)->planes[0].at(0, 0), 2.3879393e-38f);
    EXPECT_EQ(read("NBITS 16\nBYTEORDER I", bytes.substr(0, 8))->remark, "");
    EXPECT_EQ(read("", bytes.substr(0, 4))->remark, "");  // bytes have no order
}

TEST_F(Bil, SkipsWhatTheHeaderSays) {
    const std::string rows("hh\1\2--\3\4--", 10);
    EXPECT_EQ(texels_of(read("SKIPBYTES 2\nTOTALROWBYTES 4\nBANDROWBYTES 2", rows)), "1. 2. 3. 4.");
    EXPECT_EQ(texels_of(read("SKIPBYTES 2\nTOTALROWBYTES 4", rows.substr(0, 8))), "1. 2. 3. 4.");  // no gap at the end
    EXPECT_EQ(read("", std::string("\1\2\3\4\5", 5))->remark, "1 bytes after the last row were not read");
}

TEST_F(Bil, TheNoDataValueIsTheHeadersAndTellsTheSign) {
    const auto image = read("NBITS 16\nBYTEORDER I\nNODATA -9999", std::string("\xf1\xd8\0\0\0\0\0\0", 8));
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->no_data, -9999.0f);
    EXPECT_EQ(image->planes[0].at(0, 0), -9999.0f);
    EXPECT_EQ(read("NODATA_VALUE 255", "abcd")->no_data, 255.0f);
    EXPECT_FALSE(read("", "abcd")->no_data);
}

TEST_F(Bil, GridFloatHasFloatsAndWordsOfItsOwn) {
    write("G.HDR", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\nbyteorder LSBFIRST\n");
    write("G.FLT", std::string("\0\0\x80\x3f\0\x3c\x1c\xc6", 8));
    const auto image = read("G.FLT");
    ASSERT_TRUE(image) << image.error().message();
    EXPECT_EQ(image->planes[0].at(0, 0), 1.0f);
    EXPECT_EQ(image->planes[0].at(1, 0), image->no_data);
}

TEST_F(Bil, RefusesWhatMakesNoSense) {
    write("alone.bil", "abcd");
    const auto alone = read("alone.bil");
    ASSERT_FALSE(alone);
    EXPECT_EQ(alone.error().code, ErrorCode::io);
    EXPECT_NE(alone.error().reason.find("cannot read its header "), std::string::npos) << alone.error().reason;
    EXPECT_EQ(reason_of("", "abc"), "h.bil: 3 bytes, but its header wants 4");
    EXPECT_EQ(reason_of("SKIPBYTES 1", "abcd"), "h.bil: 4 bytes, but its header wants 5");
    EXPECT_EQ(reason_of("NBANDS 3", "abcd"), "h.hdr: 3 bands, but heights need one");
    EXPECT_EQ(reason_of("NBITS 4", "abcd"), "h.hdr: 4 bits of an integer are not supported");
    EXPECT_EQ(reason_of("NBITS 64\nPIXELTYPE FLOAT", "abcd"), "h.hdr: 64 bits of a float are not supported");
    EXPECT_EQ(reason_of("PIXELTYPE COMPLEX", "abcd"), "h.hdr: pixeltype is \"complex\"");
    EXPECT_EQ(reason_of("BYTEORDER Z", "abcd"), "h.hdr: byteorder is \"z\"");
    EXPECT_EQ(reason_of("SKIPBYTES -1", "abcd"), "h.hdr: skipbytes is \"-1\"");
    EXPECT_EQ(reason_of("NODATA none", "abcd"), "h.hdr: nodata is \"none\"");
    EXPECT_EQ(reason_of("TOTALROWBYTES 1", "abcd"), "h.hdr: totalrowbytes is \"1\"");
    EXPECT_EQ(reason_of("SKIPBYTES 1e300", "abcd"), "h.hdr: skipbytes is \"1e300\"");
    write("n.bil", "abcd");
    write("n.hdr", "NCOLS 2\n");
    EXPECT_EQ(read("n.bil").error().reason, "nrows is missing");
    write("n.hdr", "NCOLS 2000000\nNROWS 1");
    EXPECT_EQ(read("n.bil").error().code, ErrorCode::unsupported);
    write("n.hdr", "NCOLS 1e6\nNROWS 1e6\nTOTALROWBYTES 1e12\nSKIPBYTES 1e12");
    EXPECT_EQ(read("n.bil").error().code, ErrorCode::unsupported);
    write("n.hdr", "ENVI\nsamples = 2\n");
    EXPECT_EQ(read("n.bil").error().code, ErrorCode::unsupported);
    write("n.hdr", std::string(70000, 'x'));
    EXPECT_FALSE(read("n.bil"));
}

}  // namespace
}  // namespace tex
