// SPDX-License-Identifier: Apache-2.0

#include "files/unfinished_files.h"

#include <fcntl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <tex/file.h>

#include "scratch.h"

namespace tex {
namespace {

class UnfinishedFiles : public testing::Test, protected Scratch {
protected:
    void SetUp() override { descriptor_ = open(folder_.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC); }
    void TearDown() override { close(descriptor_); }
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) found.insert(entry.path().filename());
        return found;
    }
    void create(const std::string& name) const {
        close(openat(descriptor_, name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600));
    }

    // The effect of body() on the folder. It runs in a separate process, which must end with status 0.
    template <class Body>
    void in_a_process(const Body& body) {
        const pid_t child = fork();
        if (child == 0) {
            body();
            _exit(1);
        }
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
    }

    int descriptor_ = -1;
};

TEST_F(UnfinishedFiles, OnlyThoseThatExistAreRemoved) {
    for (const char* name : {"one", "two", "three"}) create(name);
    in_a_process([&] {
        UnfinishedFile one, two;
        {
            const NameSection section;
            one.add(section, descriptor_, "one");
            two.add(section, descriptor_, "two");
            two.remove(section);  // it has a different owner now
        }
        remove_unfinished_files();
        _exit(0);
    });
    EXPECT_EQ(names(), (std::set<std::string>{"two", "three"}));
}

TEST_F(UnfinishedFiles, APlaceIsUsedAgain) {
    for (const char* name : {"first", "second"}) create(name);
    in_a_process([&] {
        {
            UnfinishedFile first;
            const NameSection section;
            first.add(section, descriptor_, "first");
            first.remove(section);
        }
        UnfinishedFile second;
        {
            const NameSection section;
            second.add(section, descriptor_, "second");
        }
        remove_unfinished_files();
        _exit(0);
    });
    EXPECT_EQ(names(), (std::set<std::string>{"first"}));
}

extern "C" void end_now(int) {
    remove_unfinished_files();
    _exit(0);
}

// Several threads create files and give them names. The signal comes to any of them at any time.
TEST_F(UnfinishedFiles, ASignalAtAnyMomentLeavesNoTemporaryName) {
    for (int round = 0; round < 6; ++round) {
        SCOPED_TRACE(round);
        in_a_process([&] {
            struct sigaction action {};
            action.sa_handler = end_now;
            sigaction(SIGALRM, &action, nullptr);
            std::atomic<int> written{0};
            const auto write = [&](int thread) {
                const std::string target = "target" + std::to_string(thread),
                                  temporary = "temporary" + std::to_string(thread);
                for (;;) {
                    UnfinishedFile file;
                    {
                        const NameSection section;
                        create(temporary);
                        file.add(section, descriptor_, temporary);
                    }
                    const NameSection section;
                    file.remove(section);
                    renameat(descriptor_, temporary.c_str(), descriptor_, target.c_str());
                    ++written;
                }
            };
            std::vector<std::thread> threads;
            for (int k = 0; k < 3; ++k) threads.emplace_back(write, k);
            while (written == 0) std::this_thread::yield();
            const itimerval soon{{0, 0}, {0, 100 + round * 731}};
            setitimer(ITIMER_REAL, &soon, nullptr);
            for (std::thread& thread : threads) thread.join();
        });
        for (const std::string& name : names()) EXPECT_TRUE(name.starts_with("target")) << name;
    }
    EXPECT_FALSE(names().empty());
}

}  // namespace
}  // namespace tex
