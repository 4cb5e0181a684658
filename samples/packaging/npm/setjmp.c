// SPDX-License-Identifier: Apache-2.0
// setjmp.c: what clang's -wasm-enable-sjlj calls. A function that calls setjmp() is an "invocation", the address of a
// variable of its own; its calls of setjmp() have labels. longjmp() throws, with tag 1; the function catches, and asks
// which of its calls was meant.

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
