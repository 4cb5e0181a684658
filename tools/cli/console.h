// SPDX-License-Identifier: Apache-2.0
// console.h: what a command says to people, on standard error: errors, warnings, and the progress bar that
// they must not tear.
//
// All functions may be called from any thread.

#pragma once

#include <string>
#include <string_view>

namespace tex::cli {

// The name that messages begin with.
void set_program(std::string name);

// No warnings and no progress from now on. Errors are always told.
void set_quiet();

// "bake-normals: error: MESSAGE". Control characters in the message are escaped: a line stays a line.
void print_error(std::string_view message);
void print_warning(std::string_view message);

// Draws the bar, at most ten times a second: fraction 0 to 1, and a few words beside it.
void draw_progress(double fraction, std::string_view words);

// Takes the bar away.
void clear_progress();

}  // namespace tex::cli
