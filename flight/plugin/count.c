/* A plugin of QEMU that counts what runs between two marks: A32 instructions by class and, if asked
 * for, misses of a first-level cache of instructions and one of data. One line a region.
 *
 *   -plugin count.so,out=FILE[,line=BYTES]
 *
 * With `line` the caches are modelled: 32 KiB, four ways, least recently used, as on a Cortex-A8
 * (lines of 64 bytes) or A9 (32 bytes), there with random replacement. No package ships QEMU's header; what is used of its plugin
 * interface, version 1, is declared here. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t plugin_id;
typedef uint32_t mem_info;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum { NO_REGISTERS = 0, INLINE_ADD = 0, READ_AND_WRITE = 3 };
typedef void (*exec_callback)(unsigned int cpu, void *data);
typedef void (*mem_callback)(unsigned int cpu, mem_info info, uint64_t address, void *data);

void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id, void (*)(plugin_id, struct qemu_plugin_tb *));
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *, exec_callback, int, void *);
void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn *, exec_callback, int, void *);
void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn *, int, void *, uint64_t);
void qemu_plugin_register_vcpu_mem_cb(struct qemu_plugin_insn *, mem_callback, int, int, void *);
void qemu_plugin_register_atexit_cb(plugin_id, void (*)(plugin_id, void *), void *);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb *);
struct qemu_plugin_insn *qemu_plugin_tb_get_insn(const struct qemu_plugin_tb *, size_t);
const void *qemu_plugin_insn_data(const struct qemu_plugin_insn *);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;

#define CLASSES(X) \
    X(integer) X(multiply) X(load) X(store) X(branch) X(fp_add) X(fp_multiply) \
    X(fp_multiply_add) X(fp_divide) X(fp_root) X(fp_load) X(fp_store) X(fp_move) X(other)
#define AS_NAME(name) #name ",",
#define AS_CONSTANT(name) name,
enum class { CLASSES(AS_CONSTANT) CLASS_COUNT };
static const char *const NAMES[] = {CLASSES(AS_NAME)};

enum { MARK_BEGIN = 0xe1a0a00a, MARK_END = 0xe1a0b00b }; /* mov r10, r10; mov r11, r11 */
enum { CACHE_BYTES = 32 << 10, WAYS = 4, MOST_SETS = CACHE_BYTES / WAYS / 32 };

static uint64_t counts[CLASS_COUNT];
static uint64_t line_bytes, sets;
static struct cache { uint64_t tags[MOST_SETS][WAYS], misses; } instructions, data;
static FILE *out;

static void touch(struct cache *cache, uint64_t address)
{
    uint64_t line = address / line_bytes + 1, *tags = cache->tags[line % sets];
    int way = 0;
    while (way < WAYS - 1 && tags[way] != line)
        way++;
    cache->misses += tags[way] != line;
    memmove(tags + 1, tags, way * sizeof *tags);
    tags[0] = line;
}

static bool bit(uint32_t word, int place) { return word >> place & 1; }

static enum class floating_point(uint32_t word)
{
    switch (word >> 20 & 0xb) {
    case 0x0: case 0x1: return fp_multiply_add;
    case 0x2: return fp_multiply;
    case 0x3: return fp_add;
    case 0x8: return fp_divide;
    }
    return (word >> 16 & 0xf) == 1 && (word >> 6 & 3) == 3 ? fp_root : fp_move;
}

/* The class of an A32 instruction, by the encodings of the Arm architecture manual, A5. */
static enum class class_of(uint32_t word)
{
    if (word >> 28 == 0xf)
        return other;
    bool on_unit = (word >> 9 & 7) == 5; /* coprocessors 10 and 11 */
    switch (word >> 25 & 7) {
    case 0:
        if (bit(word, 7) && bit(word, 4)) {
            if (word >> 5 & 3)
                return bit(word, 20) || (word >> 5 & 3) == 2 ? load : store;
            return bit(word, 24) ? other : multiply;
        }
        return (word & 0x0fffffd0) == 0x012fff10 ? branch : integer; /* BX, BLX */
    case 1: return integer;
    case 2: return bit(word, 20) ? load : store;
    case 3: return bit(word, 4) ? integer : bit(word, 20) ? load : store;
    case 4: return bit(word, 20) ? load : store;
    case 5: return branch;
    case 6:
        if (!on_unit)
            return other;
        return (word >> 21 & 0xf) == 2 ? fp_move : bit(word, 20) ? fp_load : fp_store;
    }
    if (bit(word, 24) || !on_unit)
        return other;
    return bit(word, 4) ? fp_move : floating_point(word);
}

static void begin(unsigned int cpu, void *unused)
{
    memset(counts, 0, sizeof counts);
    instructions.misses = data.misses = 0;
}

static void end(unsigned int cpu, void *unused)
{
    for (int i = 0; i < CLASS_COUNT; i++)
        fprintf(out, "%" PRIu64 ",", counts[i]);
    fprintf(out, "%" PRIu64 ",%" PRIu64 "\n", instructions.misses, data.misses);
}

static void fetch(unsigned int cpu, void *first_and_count)
{
    uint64_t first = (uintptr_t)first_and_count >> 16, bytes = (uintptr_t)first_and_count & 0xffff;
    for (uint64_t line = first / line_bytes; line <= (first + bytes - 1) / line_bytes; line++)
        touch(&instructions, line * line_bytes);
}

static void access(unsigned int cpu, mem_info info, uint64_t address, void *unused)
{
    touch(&data, address);
}

static void translate(plugin_id id, struct qemu_plugin_tb *tb)
{
    size_t count = qemu_plugin_tb_n_insns(tb);
    if (line_bytes)
        qemu_plugin_register_vcpu_tb_exec_cb(
            tb, fetch, NO_REGISTERS,
            (void *)(uintptr_t)(qemu_plugin_tb_vaddr(tb) << 16 | 4 * count));
    for (size_t i = 0; i < count; i++) {
        struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(tb, i);
        uint32_t word;
        memcpy(&word, qemu_plugin_insn_data(insn), sizeof word);
        if (word == MARK_BEGIN || word == MARK_END) {
            exec_callback mark = word == MARK_BEGIN ? begin : end;
            qemu_plugin_register_vcpu_insn_exec_cb(insn, mark, NO_REGISTERS, NULL);
            continue;
        }
        uint64_t *counter = &counts[class_of(word)];
        qemu_plugin_register_vcpu_insn_exec_inline(insn, INLINE_ADD, counter, 1);
        if (line_bytes)
            qemu_plugin_register_vcpu_mem_cb(insn, access, NO_REGISTERS, READ_AND_WRITE, NULL);
    }
}

static void finish(plugin_id id, void *unused) { fclose(out); }

__attribute__((visibility("default"))) int
qemu_plugin_install(plugin_id id, const void *info, int argc, char **argv)
{
    for (int i = 0; i < argc; i++) {
        if (!strncmp(argv[i], "out=", 4))
            out = fopen(argv[i] + 4, "w");
        if (!strncmp(argv[i], "line=", 5))
            line_bytes = strtoull(argv[i] + 5, NULL, 10);
    }
    if (!out)
        return 1;
    sets = line_bytes ? CACHE_BYTES / WAYS / line_bytes : 0;
    for (int i = 0; i < CLASS_COUNT; i++)
        fputs(NAMES[i], out);
    fputs("instruction_misses,data_misses\n", out);
    qemu_plugin_register_vcpu_tb_trans_cb(id, translate);
    qemu_plugin_register_atexit_cb(id, finish, NULL);
    return 0;
}
