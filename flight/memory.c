/* What the compiler calls to copy and to clear memory, in the instruction set and with the flags of
 * everything else, so that what is counted is the same whatever C library is installed. */
#include <stddef.h>
#include <stdint.h>

void *memcpy(void *restrict to, const void *restrict from, size_t bytes)
{
    uint8_t *out = to;
    const uint8_t *in = from;
    if (((uintptr_t)out | (uintptr_t)in) % 4 == 0)
        for (; bytes >= 4; bytes -= 4, out += 4, in += 4)
            *(uint32_t *)out = *(const uint32_t *)in;
    while (bytes--)
        *out++ = *in++;
    return to;
}

void *memset(void *to, int byte, size_t bytes)
{
    uint8_t *out = to;
    uint32_t word = 0x01010101u * (uint8_t)byte;
    if ((uintptr_t)out % 4 == 0)
        for (; bytes >= 4; bytes -= 4, out += 4)
            *(uint32_t *)out = word;
    while (bytes--)
        *out++ = (uint8_t)byte;
    return to;
}
