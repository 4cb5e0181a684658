// SPDX-License-Identifier: Apache-2.0
// Rights beyond owner, group and mode. A file that replaces another one keeps its ACL and attributes, and nobody has
// more rights than before.

#include "files/file_rights.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <sys/xattr.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <tex/file.h>

#include "scratch.h"

namespace tex {
namespace {

constexpr const char* kAcl = "system.posix_acl_access";

struct Entry {
    std::uint16_t tag, rights;
    std::uint32_t id = 0xffffffff;
};
constexpr std::uint16_t kOwner = 1, kUser = 2, kOwningGroup = 4, kNamedGroup = 8, kMask = 16, kOther = 32;

// In the form in which Linux stores it; setfacl makes the same.
std::string acl(const std::vector<Entry>& entries) {
    std::string bytes("\x02\0\0\0", 4);
    const auto put = [&](std::uint32_t value, int count) {
        for (int k = 0; k < count; ++k) bytes += static_cast<char>(value >> 8 * k & 0xff);
    };
    for (const Entry& entry : entries) put(entry.tag, 2), put(entry.rights, 2), put(entry.id, 4);
    return bytes;
}

const std::string kOneUser = acl({{kOwner, 6}, {kUser, 6, 1234}, {kOwningGroup, 0}, {kMask, 6}, {kOther, 0}});

class FileRights : public testing::Test, protected Scratch {
protected:
    void SetUp() override {
        file_ = folder_ + "/a";
        std::ofstream(file_) << "old";
        if (!set(file_, kAcl, kOneUser)) GTEST_SKIP() << "the file system of " << folder_ << " has no ACLs";
        removexattr(file_.c_str(), kAcl);
    }

    static bool set(const std::string& path, const char* name, const std::string& value) {
        return setxattr(path.c_str(), name, value.data(), value.size(), 0) == 0;
    }
    static std::string get(const std::string& path, const char* name) {
        char bytes[1000];
        const ssize_t size = getxattr(path.c_str(), name, bytes, sizeof bytes);
        return size < 0 ? "none" : std::string(bytes, static_cast<std::size_t>(size));
    }
    [[nodiscard]] mode_t mode() const {
        struct stat status {};
        return stat(file_.c_str(), &status) == 0 ? status.st_mode & 07777 : 0;
    }
    void replace() const {
        const Result<void> written = write_file(file_, {std::byte{1}});
        ASSERT_TRUE(written) << written.error().message();
    }
    std::string file_;
};

mode_t without(mode_t mode, const std::string& list) {
    return mode_without_acl(mode, {reinterpret_cast<const std::byte*>(list.data()), list.size()});
}

}  // namespace

// In a file's mode, the mask takes the place of the group's rights. An earlier version gave these rights to the group.
TEST_F(FileRights, AnAclIsKept) {
    ASSERT_TRUE(set(file_, kAcl, kOneUser));
    ASSERT_EQ(mode(), 0660u);
    replace();
    EXPECT_EQ(get(file_, kAcl), kOneUser);
    EXPECT_EQ(mode(), 0660u);
}

TEST_F(FileRights, AttributesOfTheUserAreKept) {
    ASSERT_TRUE(set(file_, "user.origin", "here"));
    ASSERT_TRUE(set(file_, "user.empty", ""));
    replace();
    EXPECT_EQ(get(file_, "user.origin"), "here");
    EXPECT_EQ(get(file_, "user.empty"), "");
}

// A folder's default ACL applies only to files that are new in it.
TEST_F(FileRights, TheFoldersAclIsNotForAFileThatHadNone) {
    ASSERT_EQ(chmod(file_.c_str(), 0640), 0);
    ASSERT_TRUE(set(folder_, "system.posix_acl_default", kOneUser));
    replace();
    EXPECT_EQ(get(file_, kAcl), "none");
    EXPECT_EQ(mode(), 0640u);
    ASSERT_TRUE(write_file(folder_ + "/new", {std::byte{1}}));
    EXPECT_NE(get(folder_ + "/new", kAcl), "none");
}

TEST(FileRightsWithoutAcl, NobodyHasMoreThanBefore) {
    // The group itself had no rights.
    EXPECT_EQ(without(0660, kOneUser), 0600u);
    EXPECT_EQ(without(0664, acl({{kOwner, 6}, {kUser, 6, 1}, {kOwningGroup, 4}, {kMask, 6}, {kOther, 4}})), 0644u);
    // The mask removes rights from the group.
    EXPECT_EQ(without(0640, acl({{kOwner, 6}, {kUser, 6, 1}, {kOwningGroup, 6}, {kMask, 4}, {kOther, 0}})), 0640u);
    // A user who was denied by name now counts as one of the others, or of the group.
    EXPECT_EQ(without(0664, acl({{kOwner, 6}, {kUser, 0, 1}, {kOwningGroup, 6}, {kMask, 6}, {kOther, 4}})), 0600u);
    EXPECT_EQ(without(0664, acl({{kOwner, 6}, {kOwningGroup, 6}, {kNamedGroup, 0, 1}, {kMask, 6}, {kOther, 4}})),
              0660u);
    EXPECT_EQ(without(04755, acl({{kOwner, 7}, {kOwningGroup, 5}, {kOther, 5}})), 04755u);
}

TEST(FileRightsWithoutAcl, OfWhatIsNotUnderstoodTheOwnerHasRights) {
    for (const std::string& list : {std::string(), std::string("\x03\0\0\0", 4), std::string("\x02\0\0\0", 4),
                                    kOneUser.substr(0, kOneUser.size() - 1)})
        EXPECT_EQ(without(0664, list), 0600u);
}

}  // namespace tex
