/* Plays recorded calls with a compiled kernel, and prints how far its answers are from those of the
 * kernel that was recorded:
 *
 *     python tools/record_kernel.py calls.bin
 *     cc tools/play_kernel.c -o play_kernel        (or another machine's compiler)
 *     ./play_kernel calls.bin _kernel_native.so
 *
 * A line for each array that the kernel wrote: call, struct, field, largest difference, largest
 * number recorded. record_kernel.py defines the file; structs are laid out alike on all machines
 * of 64 bits, and the kernel's own tables of layouts are compared with the file's.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
static void *opened(const char *path) { return (void *)LoadLibraryA(path); }
static void *found(void *library, const char *name) { return (void *)GetProcAddress(library, name); }
#else
#include <dlfcn.h>
static void *opened(const char *path) { return dlopen(path, RTLD_NOW); }
static void *found(void *library, const char *name) { return dlsym(library, name); }
#endif

#define STRUCTS 6 /* that each of the calls has */
#define ARRAYS 64

typedef struct {
    char name[32];
    int32_t offset, kind; /* place of its pointer in the struct; 'f', 'd', 'i' or 'q' */
    int64_t bytes;
    char *now, *after;
} array;

typedef struct {
    char name[32];
    int32_t size, arrays;
    char *memory;
    array array[ARRAYS];
} structure;

typedef struct {
    const char *name;
    int32_t offset, size;
} layout_row;

static void fail(const char *why, const char *name)
{
    fprintf(stderr, "play_kernel: %s: %s\n", why, name);
    exit(1);
}

static void *bytes_of(FILE *file, int64_t count)
{
    char *memory = malloc(count ? count : 1);
    if (!memory || fread(memory, 1, count, file) != (size_t)count)
        fail("the recording is cut off or too large", "its arrays");
    return memory;
}

static void read_into(FILE *file, void *to, size_t count)
{
    if (fread(to, 1, count, file) != count)
        fail("the recording is cut off", "its headings");
}

static void *symbol(void *library, const char *name)
{
    void *there = found(library, name);
    if (!there)
        fail("the kernel lacks a symbol", name);
    return there;
}

/* The file's places of fields are those of the kernel's own table. */
static void check_layout(void *library, const structure *s)
{
    char name[64];
    snprintf(name, sizeof name, "seacage_layout_%s", s->name);
    const layout_row *row = symbol(library, name);
    int arrays = 0;
    for (; row->name; row++)
        for (int i = 0; i < s->arrays; i++)
            if (!strcmp(row->name, s->array[i].name)) {
                arrays++;
                if (row->offset != s->array[i].offset)
                    fail("a field lies elsewhere in the kernel's struct", row->name);
            }
    if (arrays != s->arrays || row->size != s->size)
        fail("the kernel lays a struct out otherwise", s->name);
}

static void read_structure(FILE *file, structure *s)
{
    read_into(file, s->name, sizeof s->name);
    read_into(file, &s->size, sizeof s->size);
    read_into(file, &s->arrays, sizeof s->arrays);
    if (s->arrays > ARRAYS)
        fail("too many arrays in struct", s->name);
    s->memory = bytes_of(file, s->size);
    for (int i = 0; i < s->arrays; i++) {
        array *a = &s->array[i];
        read_into(file, a->name, sizeof a->name);
        read_into(file, &a->offset, sizeof a->offset);
        read_into(file, &a->kind, sizeof a->kind);
        read_into(file, &a->bytes, sizeof a->bytes);
        a->now = bytes_of(file, a->bytes);
        a->after = bytes_of(file, a->bytes);
        memcpy(s->memory + a->offset, &a->now, sizeof a->now);
    }
}

static double number(const char *memory, int kind, int64_t i)
{
    return kind == 'f' ? ((const float *)memory)[i] : ((const double *)memory)[i];
}

static void compare(const char *call, const structure *s, const array *a)
{
    double largest = 0.0, size = 0.0;
    const int64_t count = a->bytes / (a->kind == 'f' ? 4 : 8);
    for (int64_t i = 0; i < count; i++) {
        const double recorded = number(a->after, a->kind, i), now = number(a->now, a->kind, i);
        const double off = recorded == now || (isnan(recorded) && isnan(now)) ? 0.0 : fabs(now - recorded);
        if (!(off <= largest))
            largest = off;
        if (fabs(recorded) > size)
            size = fabs(recorded);
    }
    printf("%s %s %s %.3g %.3g\n", call, s->name, a->name, largest, size);
}

int main(int count, char **words)
{
    if (count != 3)
        fail("give a recording and a kernel", "play_kernel CALLS KERNEL");
    FILE *file = fopen(words[1], "rb");
    void *library = opened(words[2]);
    if (!file || !library)
        fail("cannot be opened", file ? words[2] : words[1]);
    char call[32];
    static structure s[STRUCTS];
    while (fread(call, 1, sizeof call, file) == sizeof call) {
        for (int i = 0; i < STRUCTS; i++) {
            read_structure(file, &s[i]);
            check_layout(library, &s[i]);
        }
        void (*run)(void *, void *, void *, void *, void *, void *);
        void *there = symbol(library, call);
        memcpy(&run, &there, sizeof run);
        run(s[0].memory, s[1].memory, s[2].memory, s[3].memory, s[4].memory, s[5].memory);
        for (int i = 0; i < STRUCTS; i++)
            for (int j = 0; j < s[i].arrays; j++)
                if (s[i].array[j].kind == 'f' || s[i].array[j].kind == 'd')
                    compare(call, &s[i], &s[i].array[j]);
    }
    return 0;
}
