// SPDX-License-Identifier: Apache-2.0

#include "tree/state.h"

#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "cli/file_status.h"
#include "cli/text_file.h"
#include "files/path_names.h"
#include "files/system_error.h"

namespace tex::cli {
namespace {

constexpr std::string_view kStateName = "build-normals state ";
constexpr std::string_view kStateHead = "build-normals state 1\n";

// Tabs and line feeds separate fields and lines.
void add_name(std::string& text, std::string_view name) {
    for (const char c : name) {
        if (c == '%' || c == '\t' || c == '\n' || c == '\0') {
            text += fmt::format("%{:02x}", static_cast<unsigned char>(c));
        } else {
            text += c;
        }
    }
}

void add_digests(std::string& text, const NamedDigests& list) {
    text += fmt::format("\t{}", list.size());
    for (const auto& [name, digest] : list) {
        text += fmt::format("\t{}\t", digest.hex());
        add_name(text, name);
    }
}

class Fields {
public:
    explicit Fields(std::string_view line) : rest_(line) {}

    [[nodiscard]] bool ok() const { return ok_; }
    [[nodiscard]] bool has_more() const { return !done_; }
    std::string_view next() {
        const std::size_t end = rest_.find('\t');
        const std::string_view field = rest_.substr(0, end);
        if (done_) ok_ = false;
        done_ = end == std::string_view::npos;
        rest_.remove_prefix(done_ ? rest_.size() : end + 1);
        return field;
    }
    template <class T>
    T number() {
        T value{};
        const std::string_view field = next();
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || end != field.data() + field.size()) ok_ = false;
        return value;
    }
    Digest digest() {
        const std::optional<Digest> digest = Digest::from_hex(next());
        if (!digest) ok_ = false;
        return digest.value_or(Digest());
    }
    std::string name() {
        const std::string_view field = next();
        std::string name;
        for (std::size_t k = 0; k < field.size(); ++k) {
            if (field[k] != '%') {
                name += field[k];
                continue;
            }
            int code = 0;
            const char* const digits = field.data() + k + 1;
            if (k + 2 >= field.size() || std::from_chars(digits, digits + 2, code, 16).ptr != digits + 2) ok_ = false;
            name += static_cast<char>(code);
            k += 2;
        }
        return name;
    }

    NamedDigests digests() {
        NamedDigests list;
        const auto count = number<std::size_t>();
        for (std::size_t k = 0; k < count && ok_; ++k) {
            const Digest sum = digest();
            list.emplace_back(name(), sum);
        }
        return list;
    }

    std::vector<FileWarning> warnings() {
        std::vector<FileWarning> list;
        while (ok_ && has_more()) {
            FileWarning& warning = list.emplace_back();
            warning.file = name();
            warning.message = name();
            warning.is_counted = next() == "counted";
        }
        return list;
    }

private:
    std::string_view rest_;
    bool ok_ = true;
    bool done_ = false;
};

bool read_line(std::string_view line, BuildState& state) {
    Fields fields(line);
    const std::string_view kind = fields.next();
    if (kind == "file") {
        Memo memo;
        memo.stamp.device = fields.number<std::uint64_t>();
        memo.stamp.inode = fields.number<std::uint64_t>();
        memo.stamp.size = fields.number<std::int64_t>();
        memo.stamp.mtime = fields.number<std::int64_t>();
        memo.stamp.ctime = fields.number<std::int64_t>();
        memo.digest = fields.digest();
        state.memos[fields.name()] = memo;
        return fields.ok();
    }
    if (kind == "settings") {
        NamedValues& values = state.settings[fields.digest()];
        while (fields.ok() && fields.has_more()) {
            std::string name = fields.name();
            values.emplace_back(std::move(name), fields.name());
        }
        return fields.ok();
    }
    if (kind == "warned") {
        const auto made = state.outputs.find(fields.name());
        std::vector<FileWarning> warnings = fields.warnings();
        if (made != state.outputs.end()) made->second.warnings = std::move(warnings);
        return fields.ok();
    }
    if (kind != "made") return false;
    OutputRecord record;
    record.settings = fields.digest();
    record.inputs = fields.digest();
    record.input = fields.name();
    std::string output = fields.name();
    record.files = fields.digests();
    if (fields.has_more()) record.from = fields.digests();
    state.outputs[std::move(output)] = std::move(record);
    return fields.ok();
}

std::int64_t now() {
    const auto since = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(since).count();
}

}  // namespace

std::optional<FileStamp> FileStamp::of(const std::string& path) {
    const auto status = status_of(path);
    if (!status) return std::nullopt;
    return FileStamp{status->device, status->inode, status->size, status->mtime, status->ctime};
}

std::string BuildState::text(Memos memos_of) const {
    std::string text(kStateHead);
    for (const auto& [name, memo] : memos) {
        if (!memo.is_used && memos_of == Memos::used) continue;
        const FileStamp& stamp = memo.stamp;
        text += fmt::format("file\t{}\t{}\t{}\t{}\t{}\t{}\t", stamp.device, stamp.inode, stamp.size, stamp.mtime,
                            stamp.ctime, memo.digest.hex());
        add_name(text, name);
        text += '\n';
    }
    std::set<Digest> used;
    for (const auto& [output, record] : outputs) {
        text += fmt::format("made\t{}\t{}\t", record.settings.hex(), record.inputs.hex());
        add_name(text, record.input);
        text += '\t';
        add_name(text, output);
        add_digests(text, record.files);
        if (!record.from.empty()) add_digests(text, record.from);
        text += '\n';
        if (!record.warnings.empty()) {
            text += "warned\t";
            add_name(text, output);
            text += '\t' + warnings_text(record.warnings) + '\n';
        }
        used.insert(record.settings);
    }
    for (const auto& [digest, values] : settings) {
        if (!used.contains(digest)) continue;
        text += "settings\t" + digest.hex();
        for (const auto& [name, value] : values) {
            for (const std::string* const field : {&name, &value}) {
                text += '\t';
                add_name(text, *field);
            }
        }
        text += '\n';
    }
    text += "end\t" + digest_of(text).hex() + "\n";
    return text;
}

BuildState BuildState::parse(std::string_view text) {
    constexpr std::size_t kTail = 4 + 64 + 1;  // "end", a tab, the digest of what is before, a line feed
    if (!text.starts_with(kStateHead) || text.size() < kStateHead.size() + kTail) return {};
    const std::string_view tail = text.substr(text.size() - kTail);
    text.remove_suffix(kTail);
    if (!tail.starts_with("end\t") || !tail.ends_with('\n') || digest_of(text).hex() != tail.substr(4, 64)) return {};
    text.remove_prefix(kStateHead.size());
    BuildState state;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos || !read_line(text.substr(0, end), state)) return {};
        text.remove_prefix(end + 1);
    }
    return state;
}

std::string warnings_text(const std::vector<FileWarning>& warnings) {
    std::string text;
    for (const FileWarning& warning : warnings) {
        if (!text.empty()) text += '\t';
        add_name(text, warning.file);
        text += '\t';
        add_name(text, warning.message);
        text += warning.is_counted ? "\tcounted" : "\teach";
    }
    return text;
}

std::vector<FileWarning> parse_warnings(std::string_view text) {
    Fields fields(text);
    std::vector<FileWarning> warnings;
    if (!text.empty()) warnings = fields.warnings();
    return fields.ok() ? warnings : std::vector<FileWarning>();
}

Result<Digest> digest_of_file(const std::string& path) {
    FileStatus status;
    const ReadFile file = open_at_once(path, Links::followed, status);
    const auto failed = [&] { return Error{ErrorCode::io, path, system_reason(errno)}; };
    if (!file) return failed();
    if (!status.is_regular()) return Error{ErrorCode::io, path, "is not a file"};
    Sha256 sum;
    std::vector<char> buffer(std::size_t{1} << 18);
    while (true) {
        const auto count = read_from(file.get(), buffer.data(), buffer.size());
        if (!count) return failed();
        if (*count == 0) break;
        sum.add(buffer.data(), *count);
    }
    return sum.finish();
}

std::string path_from(const std::string& root, const std::string& name) {
    return root.empty() || is_absolute(name) ? name : root + "/" + name;
}

std::string state_beside(const std::string& file) {
    const std::filesystem::path path(file);
    return slashed(path.parent_path() / ("." + slashed(path.filename()) + ".state"));
}

std::set<std::string> files_made_by_builds(const std::string& folder) {
    constexpr std::size_t kMost = std::size_t{64} << 20;  // of a folder that may be anybody's
    std::set<std::string> made;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string name = slashed(entry->path().filename());
        if (!name.starts_with('.') || !name.ends_with(".state")) continue;
        const std::string path = path_from(folder, name);
        const auto text = check_is_state(path) ? read_text_file(path, kMost) : Result<std::string>(std::string());
        if (!text) continue;
        for (const auto& [output, record] : BuildState::parse(*text).outputs) {
            for (const auto& [file, digest] : record.files)
                made.insert(slashed(std::filesystem::path(path_from(folder, file)).lexically_normal()));
        }
    }
    return made;
}

Result<void> check_is_state(const std::string& path) {
    const auto known = status_of_link(path);
    if (!known) return {};
    const Error error{ErrorCode::io, path, "is not a file of build-normals, which would replace it; move it away"};
    if (!known->is_regular()) return error;
    FileStatus status;
    const ReadFile file = open_at_once(path, Links::refused, status);
    char head[kStateName.size()];
    const auto count = file ? read_from(file.get(), head, sizeof head) : std::nullopt;
    if (!count) return Error{ErrorCode::io, path, system_reason(errno)};
    // After a power cut, the file may be empty or hold zeros.
    const std::string_view begin(head, *count);
    const bool is_ours = kStateName.starts_with(begin) || begin.find_first_not_of('\0') == std::string_view::npos;
    return is_ours ? Result<void>() : error;
}

void Contents::remember(const std::string& name, const FileStamp& stamp, const Digest& digest) {
    const std::lock_guard lock(mutex_);
    memos_[name] = {stamp, digest, true};
    changed_ = true;
}

Result<Digest> Contents::digest(const std::string& name) {
    const std::string file = path(name);
    const std::optional<FileStamp> before = FileStamp::of(file);
    if (!before) return Error{ErrorCode::io, file, system_reason(errno)};
    {
        const std::lock_guard lock(mutex_);
        const auto known = memos_.find(name);
        if (known != memos_.end() && known->second.stamp == *before) {
            known->second.is_used = true;
            return known->second.digest;
        }
    }
    const Result<Digest> read = digest_of_file(file);
    if (!read) return read;
    const std::optional<FileStamp> after = FileStamp::of(file);
    // The clock of file systems has ticks of up to 10 ms. A file that was changed so recently could change again
    // without a new stamp.
    constexpr std::int64_t kTicks = 20000000;
    const bool is_settled = before->ctime < now() - kTicks && before->mtime < now() - kTicks;
    if (after == before && is_settled) remember(name, *before, *read);
    return read;
}

}  // namespace tex::cli
