/* Describes the members of a JSON object: gltf_schema.cpp describes glTF, and gltf_check.cpp compares documents with it. */
#ifndef EC_GLTF_GLTF_SCHEMA_H
#define EC_GLTF_GLTF_SCHEMA_H

#include <vector>

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

struct field {
    const char *name;           /* or a path: "outer/inner" */
    kind type;
    bool required = false;
    const char *detail = nullptr; /* index: name of the array it points into (rows: each element does); choice: the allowed values */
    double low = 0, high = 0;   /* count: range; numbers: how many (0 or less: any); rows: length of each, number of rows (0: some) */
    std::vector<field> members = {}; /* of object(s) */
};
using schema = std::vector<field>;

constexpr double int_count = 2147483647; /* indices and some offsets are kept in an int */

extern const schema document_schema;

} // namespace eclat

#endif
