/* Vectors of doubles that are as wide as the registers of the processor, for kernels that treat several points at once.
   Plain C with GNU's vector extensions. */
#pragma once

/* Doubles in a vector. The compiler splits wider vectors than the processor has, which costs many times more. */
#if defined(__AVX512F__)
enum { LANES = 8 };
#elif defined(__AVX__)
enum { LANES = 4 };
#else
enum { LANES = 2 };
#endif

typedef double    Lanes __attribute__((vector_size(LANES * sizeof(double))));
typedef long long LaneMask __attribute__((vector_size(LANES * sizeof(long long))));
/* A vector within an array of doubles, which need not be aligned */
typedef double LanesInArray __attribute__((vector_size(LANES * sizeof(double)), aligned(sizeof(double)), may_alias));

/* A point of space within an array of points, with the first number of the next one, which is carried along. Behind the
   last point such arrays have room for one number more. */
typedef double PointInArray __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double)), may_alias));

#define LANES_INLINE static inline __attribute__((always_inline))

/* Number of vectors that hold n doubles */
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

/* Absolute values: the sign bits are cleared. */
LANES_INLINE Lanes LanesAbsolute(Lanes a)
{
  return (Lanes)((LaneMask)a & ~(1ULL << 63));
}

/* The larger one of each two entries */
LANES_INLINE Lanes LanesLarger(Lanes a, Lanes b)
{
  const LaneMask from_b = b > a;

  return (Lanes)(((LaneMask)a & ~from_b) | ((LaneMask)b & from_b));
}
