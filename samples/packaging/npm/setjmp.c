// SPDX-License-Identifier: Apache-2.0
// setjmp.c: the functions that clang's -wasm-enable-sjlj calls. Each run of a function that calls setjmp() is an
// "invocation", named by the address of one of its local variables, and each such call has a number, its label.
// longjmp() throws a WebAssembly exception; the function catches it and asks here which call it belongs to.

#include <setjmp.h>
#include <stddef.h>

void __wasm_setjmp(jmp_buf environment, unsigned label, void* invocation) {
    environment->invocation = invocation;
    environment->label = label;
}

unsigned __wasm_setjmp_test(jmp_buf environment, void* invocation) {
    return environment->invocation == invocation ? environment->label : 0;
}

_Noreturn void __wasm_longjmp(jmp_buf environment, int value) {
    environment->thrown.environment = environment;
    environment->thrown.value = value != 0 ? value : 1;
    __builtin_wasm_throw(1, &environment->thrown);
}
