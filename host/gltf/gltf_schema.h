/* The language in which gltf_schema.cpp says what a glTF document looks like, and gltf_check.cpp reads it. */
#ifndef EC_GLTF_GLTF_SCHEMA_H
#define EC_GLTF_GLTF_SCHEMA_H

#include <cstddef>

namespace eclat {

enum class kind {
    index,
    indices,
    count,
    number,
    numbers,
    index_rows,
    number_rows,
    text,
    texts,
    flag,
    choice,
    accessor_type,
    object,
    objects,
    dictionary
};

struct schema;
struct field {
    const char *name;      /* or a path: "outer/inner" */
    kind type;
    bool required;
    const char *detail;    /* index: the array pointed into (rows: each element); choice: what is allowed */
    const schema *members; /* object(s) */
    double low, high;      /* count; numbers: how many (0 or less: any); rows: how long each is, how many (0: some) */
};
struct schema {
    const field *fields;
    size_t count;
    template <size_t n> constexpr schema(const field (&list)[n]) : fields(list), count(n) {}
};

constexpr double int_count = 2147483647; /* indices and some offsets are kept in an int */

extern const schema document_schema;

} // namespace eclat

#endif
