/* The types of the controller that the tests need, on this computer. */
#ifndef PLCTYPES_H
#define PLCTYPES_H
#include <stdint.h>
typedef double LREAL;
typedef uint32_t UDINT;
typedef unsigned char BOOL;
#endif
