# SPDX-License-Identifier: Apache-2.0
# Cross-compiles for Linux on arm64 with Debian's compilers. In the environment: TEX_SYSROOT, a root with the packages
# of Debian for arm64 (arm64_root.sh), and TEX_PREFIX, where libraries.sh installs what it builds.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_SYSROOT $ENV{TEX_SYSROOT})
set(CMAKE_FIND_ROOT_PATH $ENV{TEX_PREFIX})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
