/* A hash of bytes for the names of files: FNV-1a with 64 bits (Fowler, Noll, Vo). It needs no library and spreads well
   enough for a name. HashBytes() goes on from an earlier hash, HASH_START is the first one. HashFinish() makes every
   bit depend on every other (the last step of MurmurHash3, Appleby), which a sum of hashes needs: values that differ in
   one digit have hashes that differ by a small multiple of one constant, and sums of such hashes coincide. */
#pragma once
#include <stddef.h>
#include <stdint.h>

#define HASH_START 14695981039346656037ull

static inline uint64_t HashBytes(uint64_t hash, const char *data, size_t size)
{
  for (size_t i = 0; i < size; i++) hash = (hash ^ (unsigned char)data[i]) * 1099511628211ull;
  return hash;
}

static inline uint64_t HashFinish(uint64_t hash)
{
  hash = (hash ^ (hash >> 33)) * 0xff51afd7ed558ccdull;
  hash = (hash ^ (hash >> 33)) * 0xc4ceb9fe1a85ec53ull;
  return hash ^ (hash >> 33);
}
