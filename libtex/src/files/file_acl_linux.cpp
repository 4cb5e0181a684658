// SPDX-License-Identifier: Apache-2.0

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <vector>

#include "files/descriptor.h"
#include "files/file_acl.h"
#include "files/file_rights.h"

namespace tex::inline v1 {
namespace {

constexpr const char* kAcl = "system.posix_acl_access";
constexpr mode_t kAllButOwner = S_ISGID | S_IRWXG | S_IRWXO;

// The extended attributes of a file, which need not be readable.
class Attributes {
public:
    // Access through /proc needs no right to read the file. Without /proc, the file is opened.
    Attributes(int folder, const std::string& name)
        : path_("/proc/self/fd/" + std::to_string(folder) + "/" + name),
          file_(::openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)) {}

    // nullopt, and errno, if the file lacks the attribute.
    [[nodiscard]] std::optional<std::vector<std::byte>> get(const char* attribute) const {
        return whole([&](void* to, std::size_t size) {
            return file_ ? fgetxattr(file_.get(), attribute, to, size) : lgetxattr(path_.c_str(), attribute, to, size);
        });
    }
    [[nodiscard]] std::vector<std::string> names() const {
        const auto list = whole([&](void* to, std::size_t size) {
            auto* const text = static_cast<char*>(to);
            return file_ ? flistxattr(file_.get(), text, size) : llistxattr(path_.c_str(), text, size);
        });
        std::vector<std::string> names;
        if (!list) return names;
        std::string_view text(reinterpret_cast<const char*>(list->data()), list->size());
        for (std::size_t end; (end = text.find('\0')) != std::string_view::npos; text.remove_prefix(end + 1))
            names.emplace_back(text.substr(0, end));
        return names;
    }

private:
    // Calls read(to, size) with the size that read() requests. The size may change between two calls.
    template <class Read>
    static std::optional<std::vector<std::byte>> whole(const Read& read) {
        for (int tries = 0; tries < 8; ++tries) {
            const ssize_t size = read(nullptr, 0);
            if (size < 0) return std::nullopt;
            std::vector<std::byte> bytes(static_cast<std::size_t>(size));
            if (size == 0) return bytes;
            const ssize_t got = read(bytes.data(), bytes.size());
            if (got < 0 && errno != ERANGE) return std::nullopt;
            if (got < 0) continue;
            bytes.resize(static_cast<std::size_t>(got));
            return bytes;
        }
        return std::nullopt;
    }

    std::string path_;
    Descriptor file_;
};

// ACL entries follow a version number of 32 bits; everything is little-endian.
constexpr std::size_t kVersionBytes = 4, kEntryBytes = 8;
constexpr std::uint32_t kVersion = 2;
enum class Tag : std::uint32_t { owner = 1, user = 2, group = 4, named_group = 8, mask = 16, other = 32 };

std::uint32_t little_endian(std::span<const std::byte> bytes) {
    std::uint32_t value = 0;
    for (std::size_t k = bytes.size(); k-- > 0;) value = value << 8 | std::to_integer<std::uint32_t>(bytes[k]);
    return value;
}

// Gives `fd` the ACL of the old file, or none if that file has none. If this fails, the returned mode still gives
// nobody more rights than before.
mode_t with_acl(int fd, const Attributes& old, mode_t mode, bool owners_kept) {
    const auto acl = old.get(kAcl);
    const bool has_none = !acl && (errno == ENODATA || errno == EOPNOTSUPP);
    // The folder may have given the new file an ACL, which `mode` would activate.
    const bool is_clean = fremovexattr(fd, kAcl) == 0 || errno == ENODATA || errno == EOPNOTSUPP;
    if (has_none) return is_clean ? mode : mode & ~kAllButOwner;
    if (acl && owners_kept && fsetxattr(fd, kAcl, acl->data(), acl->size(), 0) == 0) return mode;
    return acl && is_clean ? mode_without_acl(mode, *acl) : mode & ~kAllButOwner;
}

}  // namespace

mode_t mode_without_acl(mode_t mode, std::span<const std::byte> acl) {
    if (acl.size() < kVersionBytes || (acl.size() - kVersionBytes) % kEntryBytes != 0 ||
        little_endian(acl.first(kVersionBytes)) != kVersion)
        return mode & ~kAllButOwner;
    // Users and groups with their own entry fall back to the rights of the group or of all others.
    const mode_t most = (mode & S_IRWXG) >> 3;
    std::optional<mode_t> of_group;
    mode_t of_users = S_IRWXO;
    mode_t of_named = S_IRWXO;
    for (auto entries = acl.subspan(kVersionBytes); !entries.empty(); entries = entries.subspan(kEntryBytes)) {
        const mode_t rights = little_endian(entries.subspan(2, 2)) & S_IRWXO & most;
        switch (static_cast<Tag>(little_endian(entries.first(2)))) {
            case Tag::group: of_group = rights; break;
            case Tag::user:
                of_users &= rights;
                of_named &= rights;
                break;
            case Tag::named_group: of_named &= rights; break;
            default: break;
        }
    }
    if (!of_group) return mode & ~kAllButOwner;
    return (mode & ~static_cast<mode_t>(S_IRWXG | S_IRWXO)) | (*of_group & of_users) << 3 | (mode & of_named);
}

mode_t keep_acl(int fd, int folder, const std::string& name, mode_t mode, bool owners_kept) {
    const Attributes attributes(folder, name);
    mode = with_acl(fd, attributes, mode, owners_kept);
    for (const std::string& attribute : attributes.names()) {
        if (!attribute.starts_with("user.")) continue;
        if (const auto value = attributes.get(attribute.c_str()))
            static_cast<void>(fsetxattr(fd, attribute.c_str(), value->data(), value->size(), 0));
    }
    return mode;
}

}  // namespace tex::inline v1
