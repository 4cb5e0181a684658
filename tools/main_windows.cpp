// SPDX-License-Identifier: Apache-2.0
// main() of every command on Windows, where no file may stand for many: all commands are in one library beside their
// programs (commands_windows.cpp), and a program names the one that it is.

extern "C" __declspec(dllimport) int tex_command(const char* name);

int main() { return tex_command(TEX_COMMAND); }
