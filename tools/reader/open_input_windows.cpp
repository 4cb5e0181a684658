// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstring>
#include <new>
#include <stdexcept>

#include "here_windows.h"
#include "open_input.h"

namespace tex::reader {
namespace {

// The input, as libtiff reads it.
struct Reading {
    const Here& job;
    std::uint64_t at = 0;
};

Reading& reading_of(thandle_t handle) { return *static_cast<Reading*>(handle); }

tmsize_t read_tiff(thandle_t handle, void* to, tmsize_t count) {
    Reading& reading = reading_of(handle);
    const std::uint64_t size = reading.job.size();
    const std::uint64_t got = std::min(static_cast<std::uint64_t>(count), size - std::min(reading.at, size));
    if (!reading.job.read(reading.at, to, got)) return -1;
    reading.at += got;
    return static_cast<tmsize_t>(got);
}

tmsize_t write_tiff(thandle_t, void*, tmsize_t) { return -1; }

toff_t seek_tiff(thandle_t handle, toff_t offset, int from) {
    Reading& reading = reading_of(handle);
    const std::uint64_t origin = from == SEEK_CUR ? reading.at : from == SEEK_END ? reading.job.size() : 0;
    return reading.at = origin + offset;
}

int close_tiff(thandle_t handle) {
    delete &reading_of(handle);
    return 0;
}

toff_t size_of_tiff(thandle_t handle) { return reading_of(handle).job.size(); }

// A stream of OpenEXR.
class Stream final : public Imf::IStream {
public:
    explicit Stream(const Here& job) : Imf::IStream(""), job_(job), size_(job.size()) {}

    bool read(char to[], int count) override {
        const auto wanted = static_cast<std::uint64_t>(count);
        if (wanted > size_ - std::min(at_, size_) || !job_.read(at_, to, wanted))
            throw std::runtime_error("Unexpected end of file.");
        at_ += wanted;
        return at_ < size_;
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }

private:
    const Here& job_;
    const std::uint64_t size_;
    std::uint64_t at_ = 0;
};

}  // namespace

bool read_whole_input(std::vector<unsigned char>& bytes) {
    bytes.resize(here().size());
    return !bytes.empty() && here().read(0, bytes.data(), bytes.size());
}

TIFF* open_tiff_input() {
    auto* const reading = new Reading{here()};
    TIFF* const tiff = TIFFClientOpen("the file", "rm", reading, read_tiff, write_tiff, seek_tiff, close_tiff,
                                      size_of_tiff, nullptr, nullptr);
    if (tiff == nullptr) delete reading;
    return tiff;
}

Imf::MultiPartInputFile open_exr_input(std::unique_ptr<Imf::IStream>& stream, int threads) {
    stream = std::make_unique<Stream>(here());
    return {*stream, threads, false};
}

}  // namespace tex::reader
