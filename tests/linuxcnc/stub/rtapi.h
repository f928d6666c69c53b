/* A stand-in for the header of LinuxCNC, for tests: what kinematics modules use of it, in our own words. */
#ifndef STUB_RTAPI_H
#define STUB_RTAPI_H

#include <stdbool.h>
#include <stdint.h>

typedef enum { RTAPI_MSG_NONE, RTAPI_MSG_ERR, RTAPI_MSG_WARN, RTAPI_MSG_INFO } msg_level_t;

void rtapi_print_msg(msg_level_t level, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* What a module exports, and its licence, can be asked by name. */
#define EXPORT_SYMBOL(name) const char *const exported_##name = #name
#define MODULE_LICENSE(text) const char *const module_license = text

#endif
