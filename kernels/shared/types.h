/* Scalar types and asserts for structs that cross from host to device. Legal in C11 and OpenCL C 1.2. */
#ifndef EC_SHARED_TYPES_H
#define EC_SHARED_TYPES_H

#if defined(__OPENCL_C_VERSION__) || defined(__OPENCL_VERSION__)
#ifdef __clang__
#pragma clang diagnostic ignored "-Wpsabi" /* of vectors wider than the processor's, which no function from elsewhere takes */
#endif
#include "builtins.h"
#define EC_DEVICE_CODE
#define EC_INLINED static inline __attribute__((always_inline))
#ifdef CALLS /* functions that compile once each, where compiling soon matters more than running fast */
#define EC_FN static
#elif defined(LANES) && LANES > 1 /* the compiler inlines what is short: all of it took longer to compile, and rendered no faster */
#define EC_FN static inline
#else
#define EC_FN EC_INLINED
#endif
#if defined(CALLS) || (defined(LANES) && LANES > 1)
#define EC_CALLED static __attribute__((noinline)) /* compiled once a kernel: many places call it, and a call costs it little */
#else /* on a graphics card it costs memory for all that it hands over */
#define EC_CALLED EC_FN
#endif
#define EC_LOOP _Pragma("unroll 1") /* before a loop that must not be unrolled: iterations side by side take registers for all of them */
typedef int ec_int;
typedef uint ec_uint;
typedef ulong ec_ulong;
typedef float ec_float;
#else
#include <stdint.h>
#define EC_LOOP
typedef int32_t ec_int;
typedef uint32_t ec_uint;
typedef uint64_t ec_ulong;
typedef float ec_float;
#endif

#define EC_NO_ID 0xffffffffu /* no triangle */

/* A negative array size says "no" in every dialect. */
#define EC_STATIC_ASSERT_NAME_(a, b) a##b
#define EC_STATIC_ASSERT_NAME(a, b) EC_STATIC_ASSERT_NAME_(a, b)
#define EC_ASSERT(condition, name) typedef char name[(condition) ? 1 : -1]
#define EC_ASSERT_SIZE(type, bytes) EC_ASSERT(sizeof(type) == (bytes), EC_STATIC_ASSERT_NAME(type, _has_size_##bytes))

#endif
