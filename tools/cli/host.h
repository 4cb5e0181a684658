// SPDX-License-Identifier: Apache-2.0
// host.h: what a program runs in: where its words go, and who may stop it. main() runs a program in the process itself,
// with standard streams and signals; everybody else in a MemoryHost or in a host of their own.
//
// "-" as the name of a file is a standard stream of the process in every host.

#pragma once

#include <mutex>
#include <string>
#include <string_view>

namespace tex::cli {

// All functions may be called from any thread.
class Host {
public:
    virtual ~Host() = default;

    // Writes all of `text` to standard output, unbuffered. False if that failed (errno says why).
    [[nodiscard]] virtual bool write_out(std::string_view text) = 0;
    // Writes `text` to standard error as one piece. Failure is ignored: there is nowhere to report it.
    virtual void write_err(std::string_view text) = 0;

    [[nodiscard]] virtual bool out_is_terminal() const { return false; }
    [[nodiscard]] virtual bool out_is_abandoned() const { return false; }  // nobody reads it any more
    [[nodiscard]] virtual bool err_is_terminal() const { return false; }   // and one that can move its cursor
    [[nodiscard]] virtual bool err_has_color() const { return false; }

    // Called before the first file is written.
    virtual void begin() {}
    // What asks the run to stop ("SIGINT"), or empty.
    [[nodiscard]] virtual std::string_view interruption() const { return {}; }
    // Called when the run has stopped because of interruption(). If it returns, the run ends with ExitCode::io.
    virtual void end_interrupted() {}
};

// Keeps what a program prints.
class MemoryHost : public Host {
public:
    [[nodiscard]] bool write_out(std::string_view text) override { return append(out_, text); }
    void write_err(std::string_view text) override { append(err_, text); }

    // After the run.
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
