/* A stand-in for the header of LinuxCNC's master, for tests: functions read and write a pin, which is opaque. */
#ifndef STUB_HAL_H
#define STUB_HAL_H

#include "rtapi.h"

#define HAL_NAME_LEN 55

typedef enum { HAL_BIT = 1, HAL_FLOAT = 2, HAL_S32 = 3 } hal_type_t;
#define HAL_BOOL HAL_BIT
#define HAL_REAL HAL_FLOAT
typedef enum { HAL_IN = 16, HAL_OUT = 32 } hal_pdir_t;
typedef double rtapi_real;
typedef bool rtapi_bool;
typedef int32_t rtapi_s32;
typedef struct stub_bool *hal_bool_t;
typedef struct stub_sint *hal_sint_t;
typedef struct stub_real *hal_real_t;

int hal_init(const char *name);
int hal_ready(int component);
int hal_exit(int component);
void *hal_malloc(long int size);
int hal_pin_new_real(int component, hal_pdir_t direction, hal_real_t *pin, rtapi_real initial, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
int hal_pin_new_bool(int component, hal_pdir_t direction, hal_bool_t *pin, rtapi_bool initial, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
int hal_pin_new_si32(int component, hal_pdir_t direction, hal_sint_t *pin, rtapi_s32 initial, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
rtapi_real hal_get_real(const hal_real_t pin);
rtapi_real hal_set_real(hal_real_t pin, rtapi_real value);
rtapi_bool hal_get_bool(const hal_bool_t pin);
rtapi_bool hal_set_bool(hal_bool_t pin, rtapi_bool value);
rtapi_s32 hal_set_si32(hal_sint_t pin, rtapi_s32 value);

#endif
