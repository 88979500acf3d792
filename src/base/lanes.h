/* Vectors of doubles as wide as the machine's registers, for kernels that treat several points at a time. Plain C with
 * GNU vector extensions. */
#pragma once

/* Wider vectors than the machine's are taken apart by the compiler at many times the cost. */
#if defined(__AVX512F__)
enum { LANES = 8 };
#elif defined(__AVX__)
enum { LANES = 4 };
#else
enum { LANES = 2 };
#endif

typedef double    Lanes __attribute__((vector_size(LANES * sizeof(double))));
typedef long long LaneMask __attribute__((vector_size(LANES * sizeof(long long))));
/* The same within an array of doubles, which need not be aligned */
typedef double LanesInArray __attribute__((vector_size(LANES * sizeof(double)), aligned(sizeof(double)), may_alias));

#define LANES_INLINE static inline __attribute__((always_inline))

/* How many vectors hold n doubles */
static inline int LanesGroups(int n)
{
  return (n + LANES - 1) / LANES;
}

LANES_INLINE double LanesSum(Lanes a)
{
  double sum = 0;

  for (int i = 0; i < LANES; i++) sum += a[i];
  return sum;
}
