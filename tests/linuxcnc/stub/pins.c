/* The HAL of the tests: it keeps the pins of one component, and a test reads and writes them by number. */

#include "hal.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define MOST 256
#define COMPONENT 7

typedef struct {
  char name[HAL_NAME_LEN + 1];
  hal_type_t type;
  int direction;
  union {
    volatile bool bit;
    volatile int32_t number;
    volatile double real;
  } value;
} pin;

static pin pins[MOST];
static int count;
static bool is_ready;
static _Alignas(16) unsigned char memory[65536];
static size_t used;
static int messages;
static char last_message[512], component_name[64];

int hal_init(const char *name) {
  snprintf(component_name, sizeof component_name, "%s", name);
  return COMPONENT;
}

int hal_ready(int component) {
  is_ready = component == COMPONENT;
  return is_ready ? 0 : -1;
}

int hal_exit(int component) {
  count = 0;
  used = 0;
  is_ready = false;
  return component == COMPONENT ? 0 : -1;
}

void *hal_malloc(long int size) {
  void *found = &memory[used];
  used += ((size_t)size + 15u)/16u*16u;
  return used <= sizeof memory ? found : NULL;
}

/* A new pin, or NULL: for another component, of a name that is too long or exists, or that would not be found again
 * because its pointer is outside of the memory of the HAL. */
static pin *added(hal_type_t type, int direction, int component, const void *place, const char *format, va_list given) {
  const unsigned char *where = place;
  pin *one = &pins[count];
  const int length = vsnprintf(one->name, sizeof one->name, format, given);
  if (component != COMPONENT || is_ready || count + 1 >= MOST || length < 0 || length > HAL_NAME_LEN
      || where < memory || where >= memory + used) {
    return NULL;
  }
  for (int i = 0; i < count; i += 1) {
    if (strcmp(pins[i].name, one->name) == 0) {
      return NULL;
    }
  }
  one->type = type;
  one->direction = direction;
  memset((void *)&one->value, 0, sizeof one->value);
  count += 1;
  return one;
}

#ifdef HAL_REAL
#define NEW(kind, function, reference, given_type, member) \
  int function(int component, hal_pdir_t direction, reference *place, given_type initial, const char *format, ...) { \
    va_list given; \
    va_start(given, format); \
    pin *one = added(kind, (int)direction, component, place, format, given); \
    va_end(given); \
    if (one == NULL) { \
      return -22; \
    } \
    one->value.member = initial; \
    *place = (reference)(void *)one; \
    return 0; \
  }
NEW(HAL_FLOAT, hal_pin_new_real, hal_real_t, rtapi_real, real)
NEW(HAL_BIT, hal_pin_new_bool, hal_bool_t, rtapi_bool, bit)
NEW(HAL_S32, hal_pin_new_si32, hal_sint_t, rtapi_s32, number)

rtapi_real hal_get_real(const hal_real_t given) { return ((pin *)(void *)given)->value.real; }
rtapi_bool hal_get_bool(const hal_bool_t given) { return ((pin *)(void *)given)->value.bit; }
rtapi_real hal_set_real(hal_real_t given, rtapi_real value) { return ((pin *)(void *)given)->value.real = value; }
rtapi_bool hal_set_bool(hal_bool_t given, rtapi_bool value) { return ((pin *)(void *)given)->value.bit = value; }
rtapi_s32 hal_set_si32(hal_sint_t given, rtapi_s32 value) { return ((pin *)(void *)given)->value.number = value; }
#else
#define NEW(kind, function, value_type, member) \
  int function(hal_pin_dir_t direction, value_type **place, int component, const char *format, ...) { \
    va_list given; \
    va_start(given, format); \
    pin *one = added(kind, (int)direction, component, place, format, given); \
    va_end(given); \
    if (one == NULL) { \
      return -22; \
    } \
    *place = &one->value.member; \
    return 0; \
  }
NEW(HAL_FLOAT, hal_pin_float_newf, hal_float_t, real)
NEW(HAL_BIT, hal_pin_bit_newf, hal_bit_t, bit)
NEW(HAL_S32, hal_pin_s32_newf, hal_s32_t, number)
#endif

void rtapi_print_msg(msg_level_t level, const char *format, ...) {
  va_list given;
  (void)level;
  va_start(given, format);
  vsnprintf(last_message, sizeof last_message, format, given);
  va_end(given);
  messages += 1;
}

/* ---- for the test ---- */

int stub_count(void);
const char *stub_name(int number);
int stub_type(int number);
int stub_direction(int number);
double stub_get(int number);
void stub_set(int number, double value);
int stub_messages(void);
const char *stub_message(void);
const char *stub_component(void);
int stub_is_ready(void);

int stub_count(void) { return count; }
const char *stub_name(int number) { return pins[number].name; }
int stub_type(int number) { return (int)pins[number].type; }
int stub_direction(int number) { return pins[number].direction; }

double stub_get(int number) {
  const pin *one = &pins[number];
  return one->type == HAL_FLOAT ? one->value.real : one->type == HAL_BIT ? (double)one->value.bit : one->value.number;
}

void stub_set(int number, double value) {
  pin *one = &pins[number];
  if (one->type == HAL_FLOAT) {
    one->value.real = value;
  } else if (one->type == HAL_BIT) {
    one->value.bit = value != 0.0;
  } else {
    one->value.number = (int32_t)value;
  }
}

int stub_messages(void) { return messages; }
const char *stub_message(void) { return last_message; }
const char *stub_component(void) { return component_name; }
int stub_is_ready(void) { return is_ready; }
