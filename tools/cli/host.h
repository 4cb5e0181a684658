// SPDX-License-Identifier: Apache-2.0
// host.h: the environment in which a program runs: where its output goes, and who may stop it. main() runs a program
// with the standard streams and signals of the process. Other callers use a MemoryHost or their own host.
//
// As an input, "-" means standard input of the process in every host.

#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace tex::cli {

// Any thread may call any of these functions.
class Host {
public:
    virtual ~Host() = default;

    // Writes all of `text` to standard output, unbuffered. Returns false on failure (errno holds the reason).
    [[nodiscard]] virtual bool write_out(std::string_view text) = 0;
    // Writes `text` to standard error in one piece. Failure is ignored, because there is nowhere to report it.
    virtual void write_err(std::string_view text) = 0;

    // The file that an output called "-" goes to.
    [[nodiscard]] virtual std::string out_name() const { return "-"; }

    [[nodiscard]] virtual bool out_is_terminal() const { return false; }
    [[nodiscard]] virtual bool out_is_abandoned() const { return false; }  // nobody reads standard output any more
    [[nodiscard]] virtual bool err_is_terminal() const { return false; }   // a terminal that can move its cursor
    [[nodiscard]] virtual bool err_has_color() const { return false; }

    // Called before the first file is written.
    virtual void begin() {}
    // The reason why the run must stop ("SIGINT"), or empty.
    [[nodiscard]] virtual std::string_view interruption() const { return {}; }
    // Called after interruption() has stopped the run. If it returns, the run ends with ExitCode::io.
    virtual void end_interrupted() {}
};

// Keeps what a program prints.
class MemoryHost : public Host {
public:
    [[nodiscard]] bool write_out(std::string_view text) override { return append(out_, text); }
    void write_err(std::string_view text) override { append(err_, text); }

    // Valid after the run.
    [[nodiscard]] const std::string& out() const { return out_; }
    [[nodiscard]] const std::string& err() const { return err_; }

private:
    bool append(std::string& target, std::string_view text) {
        const std::lock_guard lock(mutex_);
        target += text;
        return true;
    }

    std::mutex mutex_;
    std::string out_, err_;
};

}  // namespace tex::cli
