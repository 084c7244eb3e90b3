/* Declares the built-in functions that kernels call, for a driver whose own header has 18 000 lines of them and is read anew for each program
 * (host/cl/workarounds.c): EC_OWN_BUILTINS comes with _OPENCL_H_, that header's guard. A kernel that calls another function needs it declared here;
 * functions of integers for each width, since an argument of another type would be converted silently. */
#ifndef EC_SHARED_BUILTINS_H
#define EC_SHARED_BUILTINS_H
#ifdef EC_OWN_BUILTINS

#ifndef _OPENCL_BASE_H_ /* PoCL has types in a header of their own; Oclgrind, where PoCL's row is forced, has them in the one that is kept out */
typedef unsigned char uchar;
typedef unsigned int uint;
typedef unsigned long ulong;
typedef __SIZE_TYPE__ size_t;
#define EC_VECTORS(type)                                                                                                                \
    typedef type type##2 __attribute__((ext_vector_type(2)));                                                                           \
    typedef type type##4 __attribute__((ext_vector_type(4)));                                                                           \
    typedef type type##8 __attribute__((ext_vector_type(8)));                                                                           \
    typedef type type##16 __attribute__((ext_vector_type(16)));
EC_VECTORS(float)
EC_VECTORS(int)
EC_VECTORS(uint)
EC_VECTORS(uchar)
EC_VECTORS(long)
EC_VECTORS(ulong)

#define INFINITY (__builtin_inff())
#define MAXFLOAT 0x1.fffffep127f
#define as_float(x) __builtin_astype((x), float)
#define as_float4(x) __builtin_astype((x), float4)
#define as_float8(x) __builtin_astype((x), float8)
#define as_float16(x) __builtin_astype((x), float16)
#define as_int(x) __builtin_astype((x), int)
#define as_int4(x) __builtin_astype((x), int4)
#define as_int8(x) __builtin_astype((x), int8)
#define as_int16(x) __builtin_astype((x), int16)
#define as_uint(x) __builtin_astype((x), uint)
#define as_uint4(x) __builtin_astype((x), uint4)
#define as_uint8(x) __builtin_astype((x), uint8)
#define as_uint16(x) __builtin_astype((x), uint16)
#endif

#define EC_BUILTIN __attribute__((overloadable))
#define EC_BUILTIN_CONST __attribute__((overloadable, const))

#define EC_BUILTINS_MINMAX(type, n)                                                                                                     \
    type##n EC_BUILTIN_CONST min(type##n, type##n);                                                                                     \
    type##n EC_BUILTIN_CONST max(type##n, type##n);                                                                                     \
    type##n EC_BUILTIN_CONST clamp(type##n, type##n, type##n);
#define EC_BUILTINS_INTEGER(type, n)                                                                                                    \
    EC_BUILTINS_MINMAX(type, n)                                                                                                         \
    type##n EC_BUILTIN_CONST clz(type##n);                                                                                              \
    type##n EC_BUILTIN_CONST popcount(type##n);                                                                                         \
    type##n EC_BUILTIN_CONST mul_hi(type##n, type##n);                                                                                  \
    float##n EC_BUILTIN_CONST convert_float##n(type##n);                                                                                \
    int##n EC_BUILTIN_CONST convert_int##n(type##n);                                                                                    \
    ulong##n EC_BUILTIN_CONST convert_ulong##n(type##n);
#define EC_BUILTINS_LOAD(type, n, space)                                                                                                \
    type##n EC_BUILTIN __attribute__((pure)) vload##n(size_t, const space type *);                                                      \
    void EC_BUILTIN vstore##n(type##n, size_t, space type *);
#define EC_BUILTINS_MEMORY(type, n) EC_BUILTINS_LOAD(type, n, __global) EC_BUILTINS_LOAD(type, n, __private)
#define EC_BUILTINS(n)                                                                                                                  \
    EC_BUILTINS_INTEGER(uchar, n) EC_BUILTINS_INTEGER(int, n) EC_BUILTINS_INTEGER(uint, n) EC_BUILTINS_INTEGER(long, n)                 \
    EC_BUILTINS_INTEGER(ulong, n) EC_BUILTINS_MINMAX(float, n)                                                                          \
    float##n EC_BUILTIN_CONST fma(float##n, float##n, float##n);                                                                        \
    float##n EC_BUILTIN_CONST sqrt(float##n);                                                                                           \
    float##n EC_BUILTIN_CONST fabs(float##n);                                                                                           \
    float##n EC_BUILTIN_CONST floor(float##n);                                                                                          \
    float##n EC_BUILTIN_CONST ceil(float##n);                                                                                           \
    float##n EC_BUILTIN_CONST fmin(float##n, float##n);                                                                                 \
    float##n EC_BUILTIN_CONST fmax(float##n, float##n);                                                                                 \
    float##n EC_BUILTIN_CONST copysign(float##n, float##n);                                                                             \
    int##n EC_BUILTIN_CONST isfinite(float##n);                                                                                         \
    int##n EC_BUILTIN_CONST convert_int##n(float##n);                                                                                   \
    ulong##n EC_BUILTIN_CONST upsample(uint##n, uint##n);

EC_BUILTINS()
EC_BUILTINS(2)
EC_BUILTINS(4)
EC_BUILTINS(8)
EC_BUILTINS(16)
EC_BUILTINS_MEMORY(float, 4)
EC_BUILTINS_MEMORY(float, 8)
EC_BUILTINS_MEMORY(float, 16)
EC_BUILTINS_MEMORY(uint, 4)
EC_BUILTINS_MEMORY(uint, 8)
EC_BUILTINS_MEMORY(uint, 16)
EC_BUILTINS_MEMORY(ulong, 8)

size_t EC_BUILTIN_CONST get_global_id(uint);
size_t EC_BUILTIN_CONST get_group_id(uint);
uint EC_BUILTIN atomic_add(volatile __global uint *, uint);
uint EC_BUILTIN atomic_inc(volatile __global uint *);
uint EC_BUILTIN atomic_max(volatile __global uint *, uint);

#if defined(SUBGROUPS) && defined(cl_khr_subgroup_ballot) /* lib/reserve.h */
#define EC_BUILTIN_TOGETHER __attribute__((overloadable, convergent))
uint4 EC_BUILTIN_TOGETHER sub_group_ballot(int);
uint EC_BUILTIN_TOGETHER sub_group_ballot_bit_count(uint4);
uint EC_BUILTIN_TOGETHER sub_group_ballot_exclusive_scan(uint4);
uint EC_BUILTIN_TOGETHER sub_group_broadcast_first(uint);
#endif

#endif
#endif
