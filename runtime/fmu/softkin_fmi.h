/** @file softkin_fmi.h  The types of FMI 3.0 that an FMU of softkin needs, and the names of its functions. */

#ifndef SOFTKIN_FMI_H
#define SOFTKIN_FMI_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define FMI_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define FMI_EXPORT __attribute__((visibility("default")))
#else
#define FMI_EXPORT
#endif

/* If sources of several FMUs become one program, the importer defines FMI3_FUNCTION_PREFIX, for example as `arm_`. */
#define FMI_PASTED(prefix, name) prefix##name
#define FMI_JOINED(prefix, name) FMI_PASTED(prefix, name)
#ifdef FMI3_FUNCTION_PREFIX
#define FMI(name) FMI_JOINED(FMI3_FUNCTION_PREFIX, fmi3##name)
#else
#define FMI(name) fmi3##name
#endif

typedef void *fmi3Instance;
typedef void *fmi3InstanceEnvironment;
typedef void *fmi3FMUState;
typedef uint32_t fmi3ValueReference;
typedef float fmi3Float32;
typedef double fmi3Float64;
typedef int8_t fmi3Int8;
typedef uint8_t fmi3UInt8;
typedef int16_t fmi3Int16;
typedef uint16_t fmi3UInt16;
typedef int32_t fmi3Int32;
typedef uint32_t fmi3UInt32;
typedef int64_t fmi3Int64;
typedef uint64_t fmi3UInt64;
typedef bool fmi3Boolean;
typedef const char *fmi3String;
typedef uint8_t fmi3Byte;
typedef const fmi3Byte *fmi3Binary;
typedef bool fmi3Clock;

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;

typedef void (*fmi3LogMessageCallback)(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
    fmi3String message);
/** Callbacks that no FMU of softkin calls. */
typedef void (*softkin_unused)(void);

#endif
