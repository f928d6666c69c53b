/* A stand-in for the header of LinuxCNC, for tests. */
#ifndef STUB_EMCMOTCFG_H
#define STUB_EMCMOTCFG_H

#define EMCMOT_MAX_JOINTS 16
#define EMCMOT_MAX_AXIS 9

#endif
