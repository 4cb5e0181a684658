// SPDX-License-Identifier: Apache-2.0

#include "browser/browser.h"

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tex::browser {
namespace {

constexpr int kPatience = 30'000;  // milliseconds for one answer

std::string base64_bytes(const std::string& text) {
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    for (const char c : text) {
        const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        const char* at = std::strchr(digits, c);
        if (c == '\0' || at == nullptr) continue;
        bits = bits << 6 | static_cast<unsigned>(at - digits);
        count += 6;
        if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
    }
    return bytes;
}

}  // namespace

std::string Browser::program() {
    for (const char* path : {"/usr/bin/chromium", "/usr/bin/google-chrome", "/usr/bin/chromium-browser"}) {
        if (access(path, X_OK) == 0) return path;
    }
    return {};
}

Browser::Browser(const std::string& folder) {
    // No network, no first-run pages, and WebGL in software. The sandbox does not work for root and in containers.
    const std::vector<std::string> arguments = {program(),
                                                "--headless",
                                                "--no-sandbox",
                                                "--disable-gpu",
                                                "--use-gl=angle",
                                                "--use-angle=swiftshader",
                                                "--enable-unsafe-swiftshader",
                                                "--no-first-run",
                                                "--disable-background-networking",
                                                "--disable-component-update",
                                                "--disable-sync",
                                                "--disable-quic",
                                                "--disable-dev-shm-usage",
                                                "--force-color-profile=srgb",
                                                "--hide-scrollbars",
                                                "--remote-debugging-pipe",
                                                "--user-data-dir=" + folder,
                                                "about:blank"};
    std::vector<char*> argv;
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    int there[2], back[2];
    if (pipe(there) != 0 || pipe(back) != 0 || (process_ = fork()) < 0) {
        ADD_FAILURE() << "cannot start " << program();
        return;
    }
    if (process_ == 0) {
        setpgid(0, 0);
        // By way of numbers above 9, since the pipes' own may be 3 and 4.
        const int in = fcntl(there[0], F_DUPFD, 10), out = fcntl(back[1], F_DUPFD, 10),
                  nothing = ::open("/dev/null", O_RDWR);
        dup2(in, 3);
        dup2(out, 4);
        for (const int stream : {0, 1, 2}) dup2(nothing, stream);
        for (int number = 5; number < 64; ++number) close(number);
        execv(argv[0], argv.data());
        _exit(127);
    }
    close(there[0]);
    close(back[1]);
    to_ = there[1];
    from_ = back[0];
    const Json target = exchange({{"method", "Target.createTarget"}, {"params", {{"url", "about:blank"}}}});
    const Json attached = exchange({{"method", "Target.attachToTarget"},
                                    {"params", {{"targetId", target.value("targetId", "")}, {"flatten", true}}}});
    session_ = attached.value("sessionId", "");
    for (const char* domain : {"Page.enable", "Runtime.enable", "Log.enable", "Network.enable"}) call(domain);
}

Browser::~Browser() {
    if (process_ <= 0) return;
    close(to_);
    close(from_);
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
}

Browser::Json Browser::receive() {
    for (;;) {
        if (const auto end = buffer_.find('\0'); end != std::string::npos) {
            Json message = Json::parse(buffer_.substr(0, end), nullptr, false);
            buffer_.erase(0, end + 1);
            return message;
        }
        pollfd waiting{from_, POLLIN, 0};
        static std::array<char, 1 << 16> piece;
        const ssize_t count = poll(&waiting, 1, kPatience) == 1 ? read(from_, piece.data(), piece.size()) : 0;
        if (count <= 0) return Json();
        buffer_.append(piece.data(), static_cast<std::size_t>(count));
    }
}

void Browser::note(const Json& event) {
    const std::string method = event.value("method", "");
    const Json parameters = event.value("params", Json::object());
    const auto complain = [&](const Json& about) {
        complaints_.push_back(method + ": " + about.dump().substr(0, 500));
    };
    if (method == "Page.loadEventFired") loaded_ = true;
    if (method == "Runtime.exceptionThrown") complain(parameters);
    if (method == "Runtime.consoleAPICalled" && parameters.value("type", "") != "log") complain(parameters);
    if (method == "Log.entryAdded") {
        const std::string level = parameters["entry"].value("level", "");
        // Software GL tells of its own speed, and the canvas of the test's reading it.
        const std::string text = parameters["entry"].value("text", "");
        const bool is_speed = text.find("GL Driver Message") != std::string::npos ||
                              text.find("Multiple readback operations") != std::string::npos;
        if (level == "error" || (level == "warning" && !is_speed)) complain(parameters);
    }
    if (method == "Network.requestWillBeSent") {
        const std::string url = parameters["request"].value("url", "");
        if (!url.starts_with("file:///") && !url.starts_with("data:") && url != "about:blank") complain(parameters);
    }
    if (method == "Page.javascriptDialogOpening") {
        complain(parameters);
        call("Page.handleJavaScriptDialog", {{"accept", false}});
    }
}

Browser::Json Browser::exchange(const Json& request) {
    Json message = request;
    const int id = ++last_id_;
    message["id"] = id;
    std::string text = message.dump();
    text += '\0';
    for (std::size_t at = 0; at < text.size();) {
        const ssize_t count = write(to_, text.data() + at, text.size() - at);
        if (count <= 0) return ADD_FAILURE() << "the browser is gone", Json::object();
        at += static_cast<std::size_t>(count);
    }
    for (;;) {
        const Json answer = receive();
        if (!answer.is_object())
            return ADD_FAILURE() << "the browser does not answer " << message.dump().substr(0, 200), Json::object();
        if (answer.value("id", 0) != id) {
            note(answer);
            continue;
        }
        if (answer.contains("error")) ADD_FAILURE() << answer["error"].dump() << " " << message.dump().substr(0, 200);
        return answer.value("result", Json::object());
    }
}

Browser::Json Browser::call(const std::string& method, const Json& parameters) {
    return exchange({{"method", method}, {"params", parameters}, {"sessionId", session_}});
}

double Browser::open(const std::string& path) {
    complaints_.clear();
    loaded_ = false;
    call("Page.navigate", {{"url", "file://" + path}});
    while (!loaded_) {
        const Json event = receive();
        if (!event.is_object()) return ADD_FAILURE() << path << " is not loaded", 0.0;
        note(event);
    }
    return evaluate("performance.getEntriesByType('navigation')[0].loadEventStart").get<double>();
}

Browser::Json Browser::evaluate(const std::string& expression) {
    const Json result =
        call("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
    if (result.contains("exceptionDetails"))
        ADD_FAILURE() << expression << ": " << result["exceptionDetails"].dump().substr(0, 500);
    return result.contains("result") ? result["result"].value("value", Json()) : Json();
}

bool Browser::wait_for(const std::string& expression) {
    for (int k = 0; k < 100; ++k) {
        const Json value = evaluate(expression);
        if (value.is_boolean() && value.get<bool>()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
}

void Browser::set_viewport(int width, int height) {
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
}

void Browser::move_mouse(double x, double y, bool held) {
    call("Input.dispatchMouseEvent",
         {{"type", "mouseMoved"}, {"x", x}, {"y", y}, {"button", held ? "left" : "none"}, {"buttons", held ? 1 : 0}});
}

void Browser::press_key(const std::string& key) {
    Json event = {{"type", "keyDown"}, {"key", key}};
    if (key.size() == 1) event["text"] = key;
    call("Input.dispatchKeyEvent", event);
    call("Input.dispatchKeyEvent", {{"type", "keyUp"}, {"key", key}});
}

std::string Browser::screenshot() { return base64_bytes(call("Page.captureScreenshot").value("data", "")); }

}  // namespace tex::browser
