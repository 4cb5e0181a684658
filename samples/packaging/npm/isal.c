// SPDX-License-Identifier: Apache-2.0
// isal.c: what ISA-L's inflater calls by names that stand for the best function of a processor. (Its own such list
// declares two functions of the compressor otherwise than they are, which no WebAssembly passes.)

#include <stdint.h>

struct inflate_state;
int decode_huffman_code_block_stateless_base(struct inflate_state*, uint8_t*);
int decode_huffman_code_block_stateless(struct inflate_state* state, uint8_t* start) {
    return decode_huffman_code_block_stateless_base(state, start);
}

uint32_t adler32_base(uint32_t, uint8_t*, uint32_t);
uint32_t isal_adler32(uint32_t sum, const unsigned char* bytes, uint64_t count) {
    return adler32_base(sum, (uint8_t*)bytes, (uint32_t)count);
}
