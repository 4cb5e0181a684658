// SPDX-License-Identifier: Apache-2.0
// setjmp.h: Debian 12's wasi-libc has none. clang (-wasm-enable-sjlj) turns calls of setjmp() into those of setjmp.c,
// and longjmp() into an exception of WebAssembly.

#ifndef TEX_SETJMP
#define TEX_SETJMP

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    void* invocation;
    unsigned label;
    struct {
        void* environment;
        int value;
    } thrown;
} jmp_buf[1];

int setjmp(jmp_buf) __attribute__((__returns_twice__));
void longjmp(jmp_buf, int) __attribute__((__noreturn__));
#define setjmp setjmp

#ifdef __cplusplus
}
#endif

#endif  // TEX_SETJMP
