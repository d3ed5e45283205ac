/* Layouts of the structs that Python fills: `check_layout` in _structs.py compares them with its
 * own when it loads the library. A table has a row for each field, and ends with the whole's size.
 */
#ifndef SEACAGE_LAYOUT
#define SEACAGE_LAYOUT

#include <stddef.h>
#include <stdint.h>

typedef struct {
    const char *name;
    int32_t offset, size;
} layout_row;

#define LAYOUT_FIELD(of, name) {#name, offsetof(of, name), sizeof(((of *)0)->name)}
#define LAYOUT_END(of) {NULL, 0, sizeof(of)}

#endif
