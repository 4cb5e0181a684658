// SPDX-License-Identifier: Apache-2.0
// browser.h: a headless Chromium, driven through a pipe by the DevTools protocol.

#pragma once

#include <string>
#include <vector>

#include <sys/types.h>
#include <nlohmann/json.hpp>

namespace tex::browser {

// A browser with one page. Everything that goes wrong is a failure of the running test.
class Browser {
public:
    using Json = nlohmann::json;

    // The program, or empty where this machine has none.
    static std::string program();

    // `folder` is an empty one for the browser's own files.
    explicit Browser(const std::string& folder);
    ~Browser();
    Browser(const Browser&) = delete;

    // Calls a method of the page's session and returns its result.
    Json call(const std::string& method, const Json& parameters = Json::object());

    // Opens a file and waits until it is loaded. Returns the milliseconds from the beginning of navigation to the load
    // event, as the page measured.
    double open(const std::string& path);

    // The value of a JavaScript expression; promises are awaited.
    Json evaluate(const std::string& expression);

    // Waits until the expression is true.
    bool wait_for(const std::string& expression);

    void set_viewport(int width, int height);

    // Moves the mouse to a place in the page's window, in CSS pixels; `held` with the left button down.
    void move_mouse(double x, double y, bool held = false);
    void press_key(const std::string& key);

    // PNG of the window.
    std::string screenshot();

    // Errors and warnings of the console, exceptions, dialogs, and requests for anything but the file itself and data,
    // since the last open().
    const std::vector<std::string>& complaints() const { return complaints_; }

private:
    Json exchange(const Json& message);
    Json receive();
    void note(const Json& event);

    pid_t process_ = -1;
    int to_ = -1, from_ = -1;
    int last_id_ = 0;
    bool loaded_ = false;
    std::string session_, buffer_;
    std::vector<std::string> complaints_;
};

}  // namespace tex::browser
