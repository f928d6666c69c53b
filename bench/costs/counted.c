/* A plugin of QEMU: prints, at every run of the block of code at the address `mark`, how many instructions came before it.
 * QEMU installs no header for plugins everywhere: these are the declarations that are needed, of version 1. */

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint64_t id_type;
struct qemu_plugin_tb;
typedef void (*on_block)(id_type id, struct qemu_plugin_tb *block);
typedef void (*on_run)(unsigned int processor, void *data);
void qemu_plugin_register_vcpu_tb_trans_cb(id_type id, on_block then);
void qemu_plugin_register_vcpu_tb_exec_cb(struct qemu_plugin_tb *block, on_run then, int registers, void *data);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block);
uint64_t qemu_plugin_tb_vaddr(const struct qemu_plugin_tb *block);

__attribute__((visibility("default"))) int qemu_plugin_version = 1;
static uint64_t counted, mark;

static void tell(unsigned int processor, void *data) {
  (void)processor, (void)data;
  fprintf(stderr, "%" PRIu64 "\n", counted); /* QEMU ends without writing what stdout has kept */
}

static void count(unsigned int processor, void *data) {
  (void)processor;
  counted += (uintptr_t)data;
}

static void translated(id_type id, struct qemu_plugin_tb *block) {
  (void)id;
  if (qemu_plugin_tb_vaddr(block) == mark) {
    qemu_plugin_register_vcpu_tb_exec_cb(block, tell, 0, NULL);
  }
  qemu_plugin_register_vcpu_tb_exec_cb(block, count, 0, (void *)(uintptr_t)qemu_plugin_tb_n_insns(block));
}

__attribute__((visibility("default"))) int qemu_plugin_install(
    id_type id, const void *about, int given, char **arguments) {
  (void)about;
  if (given != 1 || strncmp(arguments[0], "mark=", 5) != 0) {
    return 1;
  }
  mark = strtoull(arguments[0] + 5, NULL, 16);
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  return 0;
}
