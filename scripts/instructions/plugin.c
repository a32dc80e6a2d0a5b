// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// A plugin of qemu that writes how often each piece of code ran, to the file INSTRUCTIONS_OUT: its address, and the
// number of its instructions times how often. qemu's own header is in no Debian package.

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define EXPORT __attribute__((visibility("default")))

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb* tb);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb* tb);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           void (*callback)(qemu_plugin_id_t, struct qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb* tb, void (*callback)(unsigned, void*), int flags,
                                          void* data);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void*), void* data);

EXPORT int qemu_plugin_version = PLUGIN_VERSION;

struct Block
{
    uint64_t address, instructions, runs;
};
static struct Block blocks[1 << 20];
static size_t used;

static void count(unsigned cpu, void* data)
{
    (void)cpu;
    ((struct Block*)data)->runs++;
}

static void translated(qemu_plugin_id_t id, struct qemu_plugin_tb* tb)
{
    (void)id;
    if (used == sizeof(blocks) / sizeof(blocks[0]))
        abort();
    struct Block* block = &blocks[used++];
    block->address = qemu_plugin_tb_vaddr(tb);
    block->instructions = qemu_plugin_tb_n_insns(tb);
    qemu_plugin_register_vcpu_tb_exec_cb(tb, count, 0, block);
}

static void end(qemu_plugin_id_t id, void* data)
{
    (void)id;
    (void)data;
    FILE* file = fopen(getenv("INSTRUCTIONS_OUT"), "w");
    if (!file)
        abort();
    for (size_t i = 0; i < used; ++i)
        if (blocks[i].runs)
            fprintf(file, "%llx %llu\n", (unsigned long long)blocks[i].address,
                    (unsigned long long)(blocks[i].instructions * blocks[i].runs));
    fclose(file);
}

EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const void* info, int argc, char** argv)
{
    (void)info;
    (void)argc;
    (void)argv;
    qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
    qemu_plugin_register_atexit_cb(id, end, NULL);
    return 0;
}
