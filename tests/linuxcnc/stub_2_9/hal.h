/* A stand-in for the header of LinuxCNC 2.9, for tests: a pin is a pointer to its value. */
#ifndef STUB_HAL_H
#define STUB_HAL_H

#include "rtapi.h"

#define HAL_NAME_LEN 47

typedef enum { HAL_BIT = 1, HAL_FLOAT = 2, HAL_S32 = 3 } hal_type_t;
typedef enum { HAL_IN = 16, HAL_OUT = 32 } hal_pin_dir_t;
typedef double real_t __attribute__((aligned(8)));
typedef volatile bool hal_bit_t;
typedef volatile int32_t hal_s32_t;
#define hal_float_t volatile real_t

int hal_init(const char *name);
int hal_ready(int component);
int hal_exit(int component);
void *hal_malloc(long int size);
int hal_pin_float_newf(hal_pin_dir_t direction, hal_float_t **place, int component, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int hal_pin_bit_newf(hal_pin_dir_t direction, hal_bit_t **place, int component, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
int hal_pin_s32_newf(hal_pin_dir_t direction, hal_s32_t **place, int component, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

#endif
