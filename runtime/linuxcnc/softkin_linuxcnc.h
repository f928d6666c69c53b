/**
 * @file softkin_linuxcnc.h
 * What a kinematics module of LinuxCNC says of its machine: the rest is the same for all of them.
 */

#ifndef SOFTKIN_LINUXCNC_H
#define SOFTKIN_LINUXCNC_H

#include "softkin.h"

/** The letters of a pose, X Y Z A B C U V W, which are known by their numbers. */
#define SOFTKIN_LETTERS 9

/** Numbers that depend on the parameters of a machine. */
typedef struct {
  double flange;    /**< the z of the z axis of a flange that stays along it, else 1 */
  double tool_sense; /**< 1 if the z axis of the frame leads from the tip of the tool to its holder, or -1 */
  double turn_factors[SOFTKIN_LETTERS]; /**< the degrees that each joint adds to C, if that counts turns */
  double zeros[SOFTKIN_LETTERS];        /**< the joint values at which a machine with a table turns nothing */
} softkin_numbers;

typedef struct {
  const softkin_mechanism *kind;
  const char *name; /**< of the module */
  void *machine;    /**< memory for two machines */
  void *parameters; /**< memory for their parameters, as they were read last */
  const char *const *pins; /**< the names of the pins of the parameters */
  const char *tool_pin;    /**< the name of that of the offset of a tool, or NULL */
  int tool_length;         /**< the parameter to which it is added */
  int joint_letters[SOFTKIN_LETTERS]; /**< the letter of each joint in identity mode */
  int own_letters[SOFTKIN_LETTERS];   /**< the letter that is the value of a joint in a pose, or -1 */
  int angles;       /**< how many angles say how the flange is turned: 3 (A, B, C), 1 (C) or 0 */
  bool counts_turns; /**< C is a sum of joints, full turns included */
  bool are_axes;     /**< letters are the values of the rotary joints, the others shift in straight lines */
  int carrier;       /**< the joint whose full turns C counts, or -1 */
  bool reads_still;  /**< the inverse reads a coordinate that is not commanded, and constant */
  bool has_table;
  bool on_table[SOFTKIN_LETTERS]; /**< whether a joint turns the work */
  void (*find_numbers)(softkin_numbers *found); /**< of the machine as it is set up */
} softkin_module;

extern const softkin_module softkin_this;

#endif
