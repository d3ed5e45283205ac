/* Which of the libraries built beside this one the processor can run: x86-64-v2, -v3 or -v4.
 * Others have one library only, and answer 0. */
#if defined(__x86_64__)
#include <cpuid.h>

static uint64_t saved_by_system(void)
{
    uint32_t low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return ((uint64_t)high << 32) | low;
}

int32_t seacage_level(void)
{
    uint32_t a, b, c, d;
    const uint32_t fma = 1u << 12, movbe = 1u << 22, xsave = 1u << 27, avx = 1u << 28;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & (fma | movbe | xsave | avx)) != (fma | movbe | xsave | avx))
        return 2;
    const uint64_t saved = saved_by_system();
    if ((saved & 0x6) != 0x6 || !__get_cpuid_count(7, 0, &a, &b, &c, &d))
        return 2;
    const uint32_t level_3 = (1u << 3) | (1u << 5) | (1u << 8); /* BMI1, AVX2, BMI2 */
    if ((b & level_3) != level_3)
        return 2;
    /* AVX-512 F, DQ, CD, BW, VL, and their registers kept by the system */
    const uint32_t level_4 = (1u << 16) | (1u << 17) | (1u << 28) | (1u << 30) | (1u << 31);
    return (saved & 0xe6) == 0xe6 && (b & level_4) == level_4 ? 4 : 3;
}
#else
int32_t seacage_level(void) { return 0; }
#endif
