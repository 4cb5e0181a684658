// SPDX-License-Identifier: Apache-2.0

#include "stream/source_stage.h"

#include <algorithm>
#include <utility>

#include "formats/size_limits.h"

namespace tex::inline v1 {
namespace {

Result<void> decode_rows(RowSource& rows, const std::string& input, int first, int count,
                         std::vector<std::byte>& bytes) {
    bytes.resize(rows.row_bytes() * static_cast<std::size_t>(rows.held_rows(count)));
    Result<void> done = rows.decode(first, count, bytes.data());
    if (done && first + count == rows.extent().height) done = rows.finish();
    return done ? done : Result<void>(done.error().of(input));
}

// The rows of one strip, rounded up to whole groups of rows that the file stores together.
int whole_groups(const RowSource& rows, int strip_rows) {
    const int together = rows.rows_together();
    return std::min(rows.extent().height, (strip_rows + together - 1) / together * together);
}

// Decodes rows that must be decoded in order.
class DecodeStage final : public Stage {
public:
    DecodeStage(RowSource& rows, const std::string& input) : Stage(rows.extent(), 0), rows_(rows), input_(input) {}

    [[nodiscard]] std::vector<Need> needs(int, int) const override { return {}; }
    [[nodiscard]] bool in_order() const override { return true; }
    [[nodiscard]] bool reads() const override { return true; }
    [[nodiscard]] bool counts() const override { return true; }
    Result<void> make(Strip& strip) override {
        return decode_rows(rows_, input_, strip.first, strip.height, strip.bytes);
    }

protected:
    [[nodiscard]] int choose_strip_rows(int texels, int together) const override {
        return whole_groups(rows_, Stage::choose_strip_rows(texels, together));
    }

private:
    RowSource& rows_;
    const std::string& input_;
};

// Makes floats of decoded rows; decodes them, too, if they come in any order.
class StoreStage final : public Stage {
public:
    StoreStage(RowSource& rows, const std::string& input, const Stage* decoded, ConvertRows convert)
        : Stage(rows.extent(), 0), rows_(rows), input_(input), decoded_(decoded), convert_(std::move(convert)) {}

    [[nodiscard]] std::vector<Need> needs(int first, int end) const override {
        if (decoded_ == nullptr) return {};
        return {{decoded_, first, end}};
    }
    [[nodiscard]] bool reads() const override { return decoded_ == nullptr; }
    [[nodiscard]] bool counts() const override { return true; }
    Result<void> make(Strip& strip) override {
        if (decoded_ == nullptr) {
            const Result<void> done = decode_rows(rows_, input_, strip.first, strip.height, strip.bytes);
            if (!done) return done;
        }
        const std::vector<std::byte>& bytes = decoded_ == nullptr ? strip.bytes : decoded_->strip_of(strip.first).bytes;
        rows_.store(bytes.data(), 0, strip.height, strip.image);
        return convert_ ? convert_(strip.image, strip.height) : Result<void>();
    }

protected:
    [[nodiscard]] int choose_strip_rows(int texels, int together) const override {
        return whole_groups(rows_, Stage::choose_strip_rows(texels, together));
    }
    [[nodiscard]] std::unique_ptr<Strip> new_strip(int rows) const override {
        auto strip = std::make_unique<Strip>();
        strip->image = make_image({extent().width, rows_.held_rows(rows)}, rows_.names());
        return strip;
    }

private:
    RowSource& rows_;
    const std::string& input_;
    const Stage* const decoded_;
    const ConvertRows convert_;
};

}  // namespace

Stage& add_source(Flow& flow, RowSource& rows, const std::string& input, ConvertRows convert) {
    const Stage* decoded = nullptr;
    if (!rows.is_random()) decoded = &flow.add<DecodeStage>(rows, input);
    return flow.add<StoreStage>(rows, input, decoded, std::move(convert));
}

Error after_all_rows(RowSource& rows, const std::string& input, const Error& error) {
    const Result<void> read = rows.visit(input, [](const Image&, int, int) { return Result<void>(); });
    return read ? error : read.error();
}

}  // namespace tex::inline v1
