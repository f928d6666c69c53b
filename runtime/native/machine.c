/**
 * @file machine.c
 * The native core of the Python package: an object that holds a machine in C and answers the calls of its
 * class.
 *
 * It takes what it reads without running a line of Python: tuples and lists of plain numbers. Whatever else
 * it is given, and
 * whatever is refused, it answers `NotImplemented`; then the class calls its Python, which converts,
 * computes, or says in
 * words what is wrong. So both cores have the same answers and the same errors.
 */

#define PY_SSIZE_T_CLEAN
#define Py_LIMITED_API 0x030b0000
#include <Python.h>

#include "batches.h"
#include "machines.h"

typedef struct {
  PyObject_HEAD
  const softkin_mechanism *kind; /* NULL: every call answers NotImplemented */
  softkin_in_lanes in_lanes;
  void *machine;
  PyObject *frame, *solution, *diagnosis; /* the classes of results */
  PyObject *statuses;                     /* the members of the class Status, by their numbers */
  PyObject *array;                        /* the class of arrays, once NumPy is there */
} machine_object;

enum { SLOTS_ON_STACK = 16 };

/* ---- from Python ---- */

static bool is_row(PyObject *given, Py_ssize_t *count) {
  if (PyTuple_CheckExact(given)) {
    *count = PyTuple_Size(given);
    return true;
  }
  if (PyList_CheckExact(given)) {
    *count = PyList_Size(given);
    return true;
  }
  return false;
}

static PyObject *item_of(PyObject *row, Py_ssize_t place) {
  return PyTuple_CheckExact(row) ? PyTuple_GetItem(row, place) : PyList_GetItem(row, place);
}

/* A float, a subclass of it as in NumPy, or a whole number: what needs no conversion that Python could have a
 * say in. */
static bool take_real(PyObject *given, double *value) {
  if (PyFloat_CheckExact(given) || PyFloat_Check(given)) {
    *value = PyFloat_AsDouble(given);
    return true;
  }
  if (!PyLong_CheckExact(given)) {
    return false;
  }
  *value = PyLong_AsDouble(given);
  if (*value == -1.0 && PyErr_Occurred()) {
    PyErr_Clear();
    return false;
  }
  return true;
}

/* Whether an object is an array of NumPy, and of no class of its own: one with a mask is refused in Python.
 * */
static bool is_array(machine_object *self, PyObject *given) {
  if (self->array == NULL) {
    PyObject *name = PyUnicode_InternFromString("numpy");
    PyObject *library = name == NULL ? NULL : PyImport_GetModule(name);
    self->array = library == NULL ? NULL : PyObject_GetAttrString(library, "ndarray");
    Py_XDECREF(library);
    Py_XDECREF(name);
    PyErr_Clear();
  }
  return self->array != NULL && (PyObject *)Py_TYPE(given) == self->array;
}

/* The numbers of an array of this form, row by row; columns: 0 for an array of one dimension. */
static bool take_array(machine_object *self, PyObject *given, int rows, int columns, double *values) {
  Py_buffer view;
  if (!is_array(self, given)) {
    return false;
  }
  if (PyObject_GetBuffer(given, &view, PyBUF_STRIDES | PyBUF_FORMAT) != 0) {
    PyErr_Clear();
    return false;
  }
  const bool fits = view.format != NULL && strcmp(view.format, "d") == 0
      && view.ndim == (columns == 0 ? 1 : 2)
      && view.shape[0] == rows && (columns == 0 || view.shape[1] == columns);
  for (int i = 0; fits && i < rows; i += 1) {
    for (int j = 0; j < (columns == 0 ? 1 : columns); j += 1) {
      const char *place = (const char *)view.buf + i*view.strides[0] + (columns == 0 ? 0 : j*view.strides[1]);
      memcpy(&values[i*(columns == 0 ? 1 : columns) + j], place, sizeof(double));
    }
  }
  PyBuffer_Release(&view);
  return fits;
}

static bool take_reals(machine_object *self, PyObject *given, int count, double *values) {
  Py_ssize_t found;
  if (!is_row(given, &found)) {
    return take_array(self, given, count, 0, values);
  }
  if (found != count) {
    return false;
  }
  for (int i = 0; i < count; i += 1) {
    if (!take_real(item_of(given, i), &values[i])) {
      return false;
    }
  }
  return true;
}

static bool take_rows(machine_object *self, PyObject *given, double rotation[3][3]) {
  Py_ssize_t found;
  if (!is_row(given, &found)) {
    return take_array(self, given, 3, 3, &rotation[0][0]);
  }
  if (found != 3) {
    return false;
  }
  for (int i = 0; i < 3; i += 1) {
    if (!take_reals(self, item_of(given, i), 3, rotation[i])) {
      return false;
    }
  }
  return true;
}

/* A matrix (4, 4) whose last row is 0 0 0 1; with a row that is rounded it goes to Python. */
static bool take_matrix(machine_object *self, PyObject *given, softkin_frame *frame) {
  double cells[4][4];
  if (!take_array(self, given, 4, 4, &cells[0][0])) {
    return false;
  }
  for (int i = 0; i < 3; i += 1) {
    frame->position[i] = cells[i][3];
    memcpy(frame->rotation[i], cells[i], 3*sizeof(double));
  }
  return cells[3][0] == 0.0 && cells[3][1] == 0.0 && cells[3][2] == 0.0 && cells[3][3] == 1.0;
}

/* A frame, a pair or a matrix; a machine that reads no rotation does not look at it. */
static bool take_frame(machine_object *self, PyObject *given, softkin_frame *frame) {
  PyObject *position, *rows;
  if (PyTuple_CheckExact(given) || (PyObject *)Py_TYPE(given) == self->frame) {
    if (PyTuple_Size(given) != 2) {
      return false;
    }
    position = PyTuple_GetItem(given, 0);
    rows = PyTuple_GetItem(given, 1);
  } else if (PyList_CheckExact(given) && PyList_Size(given) == 2) {
    position = PyList_GetItem(given, 0);
    rows = PyList_GetItem(given, 1);
  } else {
    position = rows = NULL;
  }
  if (!(position == NULL ? take_matrix(self, given, frame)
      : take_reals(self, position, 3, frame->position))) {
    return false;
  }
  if (self->kind->reads_rotation) {
    return position == NULL || take_rows(self, rows, frame->rotation);
  }
  for (int i = 0; i < 9; i += 1) {
    frame->rotation[i/3][i%3] = i % 4 == 0 ? 1.0 : 0.0;
  }
  return true;
}

/* A reference, or None if the machine needs none. */
static bool take_reference(machine_object *self, PyObject *given, double *reference) {
  if (!Py_IsNone(given)) {
    return take_reals(self, given, self->kind->axis_count, reference);
  }
  for (int i = 0; i < self->kind->axis_count; i += 1) {
    reference[i] = 0.0;
  }
  return self->kind->needs_reference == NULL;
}

static bool take_byte(PyObject *given, int8_t *byte) {
  int is_large;
  if (!PyLong_CheckExact(given)) {
    return false;
  }
  const long value = PyLong_AsLongAndOverflow(given, &is_large);
  if (is_large != 0 || value < -128 || value > 255) {
    return false;
  }
  *byte = (int8_t)(value > 127 ? value - 256 : value);
  return true;
}

static bool take_bytes(PyObject *given, int count, int8_t *bytes) {
  Py_ssize_t found;
  if (!is_row(given, &found) || found != count) {
    return false;
  }
  for (int i = 0; i < count; i += 1) {
    if (!take_byte(item_of(given, i), &bytes[i])) {
      return false;
    }
  }
  return true;
}

static bool take_signs(const machine_object *self, PyObject *given, int8_t *signs) {
  const int count = self->kind->branch_count;
  if (!take_bytes(given, count, signs)) {
    return false;
  }
  for (int i = 0; i < count; i += 1) {
    if (signs[i] != 1 && signs[i] != -1) {
      return false;
    }
  }
  return true;
}

/* ---- to Python ---- */

static PyObject *unanswered(void) {
  return Py_NewRef(Py_NotImplemented);
}

/* Put a new object into a tuple that nobody else has; false if there is none. */
static bool put(PyObject *tuple, Py_ssize_t place, PyObject *value) {
  return value != NULL && PyTuple_SetItem(tuple, place, value) == 0;
}

static PyObject *drop(PyObject *incomplete) {
  Py_XDECREF(incomplete);
  return NULL;
}

static PyObject *reals_of(const double *values, int count) {
  PyObject *found = PyTuple_New(count);
  for (int i = 0; found != NULL && i < count; i += 1) {
    if (!put(found, i, PyFloat_FromDouble(values[i]))) {
      return drop(found);
    }
  }
  return found;
}

static PyObject *rows_of(const double *values, int rows, int columns) {
  PyObject *found = PyTuple_New(rows);
  for (int i = 0; found != NULL && i < rows; i += 1) {
    if (!put(found, i, reals_of(&values[i*columns], columns))) {
      return drop(found);
    }
  }
  return found;
}

static PyObject *bytes_of(const int8_t *bytes, int count) {
  PyObject *found = PyTuple_New(count);
  for (int i = 0; found != NULL && i < count; i += 1) {
    if (!put(found, i, PyLong_FromLong(bytes[i]))) {
      return drop(found);
    }
  }
  return found;
}

/* A tuple of a class of named tuples, still empty. */
static PyObject *named_tuple(PyObject *type, Py_ssize_t count) {
  return PyType_GenericAlloc((PyTypeObject *)type, count);
}

static PyObject *pair_of(PyObject *tuple, PyObject *first, PyObject *second) {
  if (tuple != NULL && put(tuple, 0, first)) {
    first = NULL;
    if (put(tuple, 1, second)) {
      return tuple;
    }
    second = NULL;
  }
  Py_XDECREF(first);
  Py_XDECREF(second);
  return drop(tuple);
}

/* ---- calls ---- */

static bool has(const machine_object *self, Py_ssize_t count, Py_ssize_t expected) {
  return self->kind != NULL && count == expected;
}

/* branch(frame, signs, reference): one branch of trusted input. */
static PyObject *branch(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_frame frame;
  double reference[SOFTKIN_MOST_AXES], axes[SOFTKIN_MOST_AXES];
  int8_t signs[SOFTKIN_MOST_BRANCHES];
  static const int8_t turns[SOFTKIN_MOST_AXES];
  if (!has(self, count, 3) || !take_frame(self, given[0], &frame) || !take_signs(self, given[1], signs)
      || !take_reference(self, given[2], reference)) {
    return unanswered();
  }
  const softkin_status status = self->kind->branch(self->machine, &frame, signs, turns, reference, axes,
      NULL);
  if (status == SOFTKIN_OK) {
    return reals_of(axes, self->kind->axis_count);
  }
  return status == SOFTKIN_BAD_INPUT ? unanswered() : Py_NewRef(Py_None);
}

/* solve(position, rotation, signs, turns, reference): one branch on its turns. */
static PyObject *solve(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_frame frame;
  double reference[SOFTKIN_MOST_AXES], axes[SOFTKIN_MOST_AXES];
  int8_t signs[SOFTKIN_MOST_BRANCHES], turns[SOFTKIN_MOST_AXES];
  if (!has(self, count, 5) || !take_reals(self, given[0], 3, frame.position)
      || !take_rows(self, given[1], frame.rotation)
      || !take_signs(self, given[2], signs) || !take_bytes(given[3], self->kind->period_count, turns)
      || !take_reals(self, given[4], self->kind->axis_count, reference)
      || self->kind->branch(self->machine, &frame, signs, turns, reference, axes, NULL) != SOFTKIN_OK) {
    return unanswered();
  }
  return reals_of(axes, self->kind->axis_count);
}

static PyObject *axes_or_none(const softkin_status *statuses, const double *axes, int slots, int width) {
  PyObject *found = PyTuple_New(slots);
  for (int slot = 0; found != NULL && slot < slots; slot += 1) {
    PyObject *own = statuses[slot] == SOFTKIN_OK ? reals_of(&axes[slot*width], width) : Py_NewRef(Py_None);
    if (!put(found, slot, own)) {
      return drop(found);
    }
  }
  return found;
}

/* branches(frame, reference): every branch of trusted input. */
static PyObject *branches(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_frame frame;
  double reference[SOFTKIN_MOST_AXES], axes[SLOTS_ON_STACK*SOFTKIN_MOST_AXES];
  softkin_status statuses[SLOTS_ON_STACK];
  if (!has(self, count, 2) || 1 << self->kind->branch_count > SLOTS_ON_STACK
      || !take_frame(self, given[0], &frame)
      || !take_reference(self, given[1], reference)
      || softkin_branches(self->kind, self->machine, &frame, reference, statuses, axes) != SOFTKIN_OK) {
    return unanswered();
  }
  return axes_or_none(statuses, axes, 1 << self->kind->branch_count, self->kind->axis_count);
}

/* inverse(frame, configuration, reference): checked, inside the limits. */
static PyObject *inverse(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_frame frame;
  double reference[SOFTKIN_MOST_AXES], axes[SOFTKIN_MOST_AXES];
  int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES];
  const int8_t *chosen = NULL;
  if (!has(self, count, 3) || !take_frame(self, given[0], &frame)
      || !take_reference(self, given[2], reference)) {
    return unanswered();
  }
  if (!Py_IsNone(given[1])) {
    if (!take_bytes(given[1], self->kind->branch_count + self->kind->period_count, bytes)) {
      return unanswered();
    }
    chosen = bytes;
  }
  if (softkin_inverse(self->kind, self->machine, &frame, chosen, reference, axes, NULL) != SOFTKIN_OK) {
    return unanswered();
  }
  return reals_of(axes, self->kind->axis_count);
}

/* The further solutions of a slot of a search. */
static PyObject *others_of(const softkin_others *others, int slot, int width) {
  Py_ssize_t found = 0, written = 0;
  for (int i = 0; i < others->count; i += 1) {
    found += others->slots[i] == slot;
  }
  PyObject *every = PyTuple_New(found);
  for (int i = 0; every != NULL && i < others->count; i += 1) {
    if (others->slots[i] == slot) {
      if (!put(every, written, reals_of(&others->axes[i*width], width))) {
        return drop(every);
      }
      written += 1;
    }
  }
  return every;
}

/* Why a slot has no axes: status, reason with the unit of the missing amount, amount, turn. */
static PyObject *diagnosis_of(const machine_object *self, const softkin_refusal *why) {
  PyObject *found = named_tuple(self->diagnosis, 5);
  PyObject *known = PyTuple_GetItem(self->statuses, why->status);
  if (found == NULL || known == NULL || !put(found, 0, Py_NewRef(known))
      || !put(found, 1, PyUnicode_FromFormat(why->unit[0] == '\0' ? "%s" : "%s [%s]", why->reason, why->unit))
      || !put(found, 2, PyFloat_FromDouble(why->missing)) || !put(found, 3, PyLong_FromLong(why->turn))
      || !put(found, 4, PyFloat_FromDouble(0.0))) {
    return drop(found);
  }
  return found;
}

static PyObject *solution_of(const machine_object *self, softkin_status status, const double *axes,
    const int8_t *bytes, PyObject *others, const softkin_refusal *why) {
  PyObject *found = others == NULL ? NULL : named_tuple(self->solution, 5);
  if (found == NULL) {
    return drop(others);
  }
  const int size = self->kind->branch_count + self->kind->period_count;
  PyObject *known = PyTuple_GetItem(self->statuses, status);
  if (!put(found, 3, others) || known == NULL || !put(found, 0, bytes_of(bytes, size))
      || !put(found, 1, status == SOFTKIN_OK ? reals_of(axes, self->kind->axis_count) : Py_NewRef(Py_None))
      || !put(found, 2, Py_NewRef(known))
      || !put(found, 4, status == SOFTKIN_OK ? Py_NewRef(Py_None) : diagnosis_of(self, why))) {
    return drop(found);
  }
  return found;
}

/* What a call of all slots writes: on the stack, or for machines with many slots or with a search on the
 * heap. */
typedef struct {
  double axes[SLOTS_ON_STACK*SOFTKIN_MOST_AXES];
  int8_t bytes[SLOTS_ON_STACK*(SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES)];
  softkin_status statuses[SLOTS_ON_STACK];
  softkin_refusal whys[SLOTS_ON_STACK];
} every_slot;

static PyObject *solutions_of(const machine_object *self, const every_slot *found,
    const softkin_others *others) {
  const int slots = 1 << self->kind->branch_count, size = self->kind->branch_count + self->kind->period_count;
  PyObject *every = PyTuple_New(slots);
  for (int slot = 0; every != NULL && slot < slots; slot += 1) {
    PyObject *further = others == NULL ? PyTuple_New(0) : others_of(others, slot, self->kind->axis_count);
    PyObject *own = solution_of(
        self, found->statuses[slot], &found->axes[slot*self->kind->axis_count], &found->bytes[slot*size],
            further, &found->whys[slot]);
    if (!put(every, slot, own)) {
      return drop(every);
    }
  }
  return every;
}

/* inverse_all(frame, reference): every slot as a Solution, checked. */
static PyObject *inverse_all(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_frame frame;
  double reference[SOFTKIN_MOST_AXES];
  every_slot found;
  if (!has(self, count, 2) || 1 << self->kind->branch_count > SLOTS_ON_STACK
      || !take_frame(self, given[0], &frame)
      || !take_reference(self, given[1], reference)) {
    return unanswered();
  }
  if (((const softkin_base *)self->machine)->is_searched) {
    double axes[SOFTKIN_MOST_SOLUTIONS*SOFTKIN_MOST_AXES];
    int slots[SOFTKIN_MOST_SOLUTIONS];
    softkin_others others = {SOFTKIN_MOST_SOLUTIONS, axes, slots, 0};
    if (softkin_inverse_all(self->kind, self->machine, &frame, reference, found.statuses, found.axes,
        found.bytes, found.whys, &others)
            != SOFTKIN_OK || others.count == SOFTKIN_MOST_SOLUTIONS) {
      return unanswered();
    }
    return solutions_of(self, &found, &others);
  }
  if (softkin_inverse_all(self->kind, self->machine, &frame, reference, found.statuses, found.axes,
      found.bytes, found.whys, NULL) != SOFTKIN_OK) {
    return unanswered();
  }
  return solutions_of(self, &found, NULL);
}

/* forward(axes): the frame and the configuration. */
static PyObject *forward(PyObject *object, PyObject *given) {
  machine_object *self = (machine_object *)object;
  double axes[SOFTKIN_MOST_AXES];
  int8_t bytes[SOFTKIN_MOST_BRANCHES + SOFTKIN_MOST_AXES];
  softkin_frame frame;
  if (self->kind == NULL || !take_reals(self, given, self->kind->axis_count, axes)
      || softkin_forward(self->kind, self->machine, axes, NULL, &frame, bytes, NULL, NULL) != SOFTKIN_OK) {
    return unanswered();
  }
  PyObject *found = pair_of(named_tuple(self->frame, 2), reals_of(frame.position, 3),
      rows_of(&frame.rotation[0][0], 3, 3));
  return pair_of(PyTuple_New(2), found, bytes_of(bytes, self->kind->branch_count + self->kind->period_count));
}

/* pose(axes): position, rotation, and the margins of the branches. */
static PyObject *pose(PyObject *object, PyObject *given) {
  machine_object *self = (machine_object *)object;
  double axes[SOFTKIN_MOST_AXES], margins[SOFTKIN_MOST_BRANCHES];
  softkin_frame frame;
  if (self->kind == NULL || !take_reals(self, given, self->kind->axis_count, axes)
      || self->kind->forward(self->machine, axes, &frame, margins, NULL) != SOFTKIN_OK) {
    return unanswered();
  }
  PyObject *found = PyTuple_New(3);
  if (found == NULL || !put(found, 0, reals_of(frame.position, 3))
      || !put(found, 1, rows_of(&frame.rotation[0][0], 3, 3))
      || !put(found, 2, reals_of(margins, self->kind->branch_count))) {
    return drop(found);
  }
  return found;
}

/* jacobian(axes): by rows. */
static PyObject *jacobian(PyObject *object, PyObject *given) {
  machine_object *self = (machine_object *)object;
  double axes[SOFTKIN_MOST_AXES], rows[SOFTKIN_MOST_ROWS*SOFTKIN_MOST_AXES];
  if (self->kind == NULL || self->kind->row_count > SOFTKIN_MOST_ROWS
      || !take_reals(self, given, self->kind->axis_count, axes)
      || self->kind->jacobian(self->machine, axes, rows, NULL) != SOFTKIN_OK) {
    return unanswered();
  }
  return rows_of(rows, self->kind->row_count, self->kind->axis_count);
}

/* margins(axes): each zero at its singularity. */
static PyObject *margins_of(PyObject *object, PyObject *given) {
  machine_object *self = (machine_object *)object;
  double axes[SOFTKIN_MOST_AXES], margins[SOFTKIN_MOST_MARGINS];
  if (self->kind == NULL || self->kind->margin_count > SOFTKIN_MOST_MARGINS
      || !take_reals(self, given, self->kind->axis_count, axes)
      || self->kind->singularity(self->machine, axes, margins, NULL) != SOFTKIN_OK) {
    return unanswered();
  }
  return reals_of(margins, self->kind->margin_count);
}

/* ---- batches ---- */

/* The arrays of a call, which are released together. */
typedef struct {
  Py_buffer views[6];
  int count;
} arrays;

static void release(arrays *held) {
  while (held->count > 0) {
    held->count -= 1;
    PyBuffer_Release(&held->views[held->count]);
  }
}

/* An array, or an error where it has another format, or fewer rows than `stop`. width: the values of a row.
 * */
static const Py_buffer *view_of(arrays *held, PyObject *given, int flags, const char *formats,
    Py_ssize_t width, Py_ssize_t stop) {
  Py_buffer *view = &held->views[held->count];
  if (PyObject_GetBuffer(given, view, flags | PyBUF_FORMAT) != 0) {
    return NULL;
  }
  held->count += 1;
  Py_ssize_t values = 1;
  for (int i = 1; i < view->ndim; i += 1) {
    values *= view->shape[i];
  }
  if (view->ndim < 1 || view->format == NULL || strlen(view->format) != 1
      || strchr(formats, view->format[0]) == NULL
      || view->shape[0] < stop || values != width) {
    PyErr_SetString(PyExc_ValueError, "an array of a batch has another form");
    return NULL;
  }
  return view;
}

/* What is read: rows (N, width) of doubles or int64, with any strides. */
static bool take_table(arrays *held, PyObject *given, const char *formats, Py_ssize_t width, Py_ssize_t stop,
    softkin_table *table) {
  const Py_buffer *view = view_of(held, given, PyBUF_STRIDES, formats, width, stop);
  if (view == NULL) {
    return false;
  }
  if (view->ndim != 2 || view->itemsize != 8) {
    PyErr_SetString(PyExc_ValueError, "a table of a batch has another form");
    return false;
  }
  *table = (softkin_table){view->buf, view->strides[0], view->strides[1]};
  return true;
}

/* None if the machine reads no rotation. */
static bool take_rotations(const machine_object *self, arrays *held, PyObject *given, Py_ssize_t stop,
    softkin_table *table) {
  *table = (softkin_table){NULL, 0, 0};
  return !self->kind->reads_rotation || take_table(held, given, "d", 9, stop, table);
}

static void *written(arrays *held, PyObject *given, const char *formats, Py_ssize_t width, Py_ssize_t stop) {
  const Py_buffer *view = view_of(held, given, PyBUF_C_CONTIGUOUS | PyBUF_WRITABLE, formats, width, stop);
  return view == NULL ? NULL : view->buf;
}

/* The rows of a batch: its last two arguments. */
static bool take_range(const machine_object *self, PyObject *const *given, Py_ssize_t count,
    Py_ssize_t expected, softkin_rows *rows) {
  if (self->kind == NULL || count != expected) {
    PyErr_SetString(PyExc_TypeError, "no machine, or other arguments");
    return false;
  }
  rows->kind = self->kind;
  rows->in_lanes = self->in_lanes;
  rows->machine = self->machine;
  rows->start = PyLong_AsSsize_t(given[count - 2]);
  rows->stop = PyLong_AsSsize_t(given[count - 1]);
  if (PyErr_Occurred()) {
    return false;
  }
  if (rows->start < 0 || rows->start > rows->stop) {
    PyErr_SetString(PyExc_ValueError, "no range of rows");
    return false;
  }
  return true;
}

static PyObject *finished(arrays *held, bool is_done) {
  release(held);
  return is_done ? Py_NewRef(Py_None) : NULL;
}

/* forward_rows(axes, positions, rotations, configurations, statuses, start, stop) */
static PyObject *forward_rows(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_rows rows;
  softkin_table axes;
  arrays held = {.count = 0};
  double *positions = NULL, *rotations = NULL;
  int8_t *configurations = NULL;
  uint8_t *statuses = NULL;
  const bool is_good = take_range(self, given, count, 7, &rows)
      && take_table(&held, given[0], "d", self->kind->axis_count, rows.stop, &axes)
      && (positions = written(&held, given[1], "d", 3, rows.stop)) != NULL
      && (rotations = written(&held, given[2], "d", 9, rows.stop)) != NULL
      && (configurations = written(&held, given[3], "b", self->kind->branch_count + self->kind->period_count,
          rows.stop)) != NULL
      && (statuses = written(&held, given[4], "B", 1, rows.stop)) != NULL;
  if (is_good) {
    Py_BEGIN_ALLOW_THREADS
    softkin_forward_rows(&rows, &axes, positions, rotations, configurations, statuses);
    Py_END_ALLOW_THREADS
  }
  return finished(&held, is_good);
}

/* inverse_rows(positions, rotations, configurations, references, axes, statuses, start, stop) */
static PyObject *inverse_rows(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_rows rows;
  softkin_table positions, rotations, configurations, references;
  arrays held = {.count = 0};
  double *axes = NULL;
  uint8_t *statuses = NULL;
  const bool is_good = take_range(self, given, count, 8, &rows)
      && take_table(&held, given[0], "d", 3, rows.stop, &positions)
      && take_rotations(self, &held, given[1], rows.stop, &rotations)
      && take_table(&held, given[2], "lq", self->kind->branch_count + self->kind->period_count, rows.stop,
          &configurations)
      && take_table(&held, given[3], "d", self->kind->axis_count, rows.stop, &references)
      && (axes = written(&held, given[4], "d", self->kind->axis_count, rows.stop)) != NULL
      && (statuses = written(&held, given[5], "B", 1, rows.stop)) != NULL;
  if (is_good) {
    Py_BEGIN_ALLOW_THREADS
    softkin_inverse_rows(&rows, &positions, &rotations, &configurations, &references, axes, statuses);
    Py_END_ALLOW_THREADS
  }
  return finished(&held, is_good);
}

/* inverse_all_rows(positions, rotations, references, axes, statuses, start, stop) */
static PyObject *inverse_all_rows(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_rows rows;
  softkin_table positions, rotations, references;
  arrays held = {.count = 0};
  double *axes = NULL;
  uint8_t *statuses = NULL;
  const bool is_good = take_range(self, given, count, 7, &rows)
      && take_table(&held, given[0], "d", 3, rows.stop, &positions)
      && take_rotations(self, &held, given[1], rows.stop, &rotations)
      && take_table(&held, given[2], "d", self->kind->axis_count, rows.stop, &references)
      && (axes = written(&held, given[3], "d",
          (Py_ssize_t)self->kind->axis_count << self->kind->branch_count, rows.stop)) != NULL
      && (statuses = written(&held, given[4], "B", (Py_ssize_t)1 << self->kind->branch_count,
          rows.stop)) != NULL;
  if (is_good) {
    Py_BEGIN_ALLOW_THREADS
    softkin_inverse_all_rows(&rows, &positions, &rotations, &references, axes, statuses);
    Py_END_ALLOW_THREADS
  }
  return finished(&held, is_good);
}

/* jacobian_rows(axes, matrices, statuses, start, stop) */
static PyObject *jacobian_rows(PyObject *object, PyObject *const *given, Py_ssize_t count) {
  machine_object *self = (machine_object *)object;
  softkin_rows rows;
  softkin_table axes;
  arrays held = {.count = 0};
  double *matrices = NULL;
  uint8_t *statuses = NULL;
  const bool is_good = take_range(self, given, count, 5, &rows)
      && take_table(&held, given[0], "d", self->kind->axis_count, rows.stop, &axes)
      && (matrices = written(&held, given[1], "d", (Py_ssize_t)self->kind->row_count*self->kind->axis_count,
          rows.stop)) != NULL
      && (statuses = written(&held, given[2], "B", 1, rows.stop)) != NULL;
  if (is_good) {
    Py_BEGIN_ALLOW_THREADS
    softkin_jacobian_rows(&rows, &axes, matrices, statuses);
    Py_END_ALLOW_THREADS
  }
  return finished(&held, is_good);
}

/* ---- the object ---- */

static const softkin_native *find(const char *key) {
  for (int i = 0; i < SOFTKIN_MACHINES; i += 1) {
    if (strcmp(softkin_machines[i].key, key) == 0) {
      return &softkin_machines[i];
    }
  }
  return NULL;
}

/* Read the parameters, and compute the constants; false if either fails. */
static bool made(const softkin_mechanism *kind, PyObject *given, void *machine) {
  char *parameters = PyMem_Calloc(1, kind->parameters_size == 0 ? 1 : kind->parameters_size);
  Py_ssize_t found;
  bool is_made = parameters != NULL && is_row(given, &found) && found == kind->parameter_count;
  for (int i = 0; is_made && i < kind->parameter_count; i += 1) {
    PyObject *item = item_of(given, i);
    double value = 0.0;
    is_made = PyBool_Check(item) ? (value = Py_IsTrue(item), true) : take_real(item, &value);
    memcpy(parameters + kind->parameters[i].place, &value, sizeof value);
  }
  is_made = is_made && softkin_init(kind, machine, parameters, NULL) == SOFTKIN_OK;
  PyMem_Free(parameters);
  return is_made;
}

/* Machine(key, parameters, Frame, Solution, Diagnosis, statuses): unknown keys and refused parameters give one that
 * answers nothing. */
static PyObject *make(PyTypeObject *type, PyObject *arguments, PyObject *keywords) {
  const char *key;
  PyObject *parameters, *frame, *solution, *diagnosis, *statuses;
  if (keywords != NULL && PyDict_Size(keywords) != 0) {
    PyErr_SetString(PyExc_TypeError, "Machine takes no keywords");
    return NULL;
  }
  if (!PyArg_ParseTuple(arguments, "sOO!O!O!O!", &key, &parameters, &PyType_Type, &frame, &PyType_Type,
      &solution, &PyType_Type, &diagnosis, &PyTuple_Type, &statuses)) {
    return NULL;
  }
  if (!PyType_IsSubtype((PyTypeObject *)frame, &PyTuple_Type)
      || !PyType_IsSubtype((PyTypeObject *)solution, &PyTuple_Type)
      || !PyType_IsSubtype((PyTypeObject *)diagnosis, &PyTuple_Type)) {
    PyErr_SetString(PyExc_TypeError, "frames, solutions and diagnoses are tuples");
    return NULL;
  }
  machine_object *self = (machine_object *)PyType_GenericAlloc(type, 0);
  if (self == NULL) {
    return NULL;
  }
  const softkin_native *found = find(key);
  self->frame = Py_NewRef(frame);
  self->solution = Py_NewRef(solution);
  self->diagnosis = Py_NewRef(diagnosis);
  self->statuses = Py_NewRef(statuses);
  if (found != NULL) {
    self->machine = PyMem_Calloc(1, found->kind->machine_size);
    if (self->machine == NULL) {
      Py_DECREF(self);
      return PyErr_NoMemory();
    }
    if (made(found->kind, parameters, self->machine)) {
      self->kind = found->kind;
      self->in_lanes = found->in_lanes;
    }
  }
  return (PyObject *)self;
}

static void destroy(PyObject *object) {
  machine_object *self = (machine_object *)object;
  PyTypeObject *type = Py_TYPE(object);
  PyMem_Free(self->machine);
  Py_XDECREF(self->frame);
  Py_XDECREF(self->solution);
  Py_XDECREF(self->diagnosis);
  Py_XDECREF(self->statuses);
  Py_XDECREF(self->array);
  freefunc release = (freefunc)PyType_GetSlot(type, Py_tp_free);
  release(object);
  Py_DECREF(type);
}

static PyObject *answers(PyObject *object, void *unused) {
  (void)unused;
  return PyBool_FromLong(((machine_object *)object)->kind != NULL);
}

static PyObject *is_searched(PyObject *object, void *unused) {
  machine_object *self = (machine_object *)object;
  (void)unused;
  return PyBool_FromLong(self->kind != NULL && ((const softkin_base *)self->machine)->is_searched);
}

#define CALL(function) (PyCFunction)(void (*)(void))function

static PyMethodDef methods[] = {
    {"branch", CALL(branch), METH_FASTCALL, NULL},
    {"branches", CALL(branches), METH_FASTCALL, NULL},
    {"inverse", CALL(inverse), METH_FASTCALL, NULL},
    {"inverse_all", CALL(inverse_all), METH_FASTCALL, NULL},
    {"solve", CALL(solve), METH_FASTCALL, NULL},
    {"forward", forward, METH_O, NULL},
    {"pose", pose, METH_O, NULL},
    {"jacobian", jacobian, METH_O, NULL},
    {"margins", margins_of, METH_O, NULL},
    {"forward_rows", CALL(forward_rows), METH_FASTCALL, NULL},
    {"inverse_rows", CALL(inverse_rows), METH_FASTCALL, NULL},
    {"inverse_all_rows", CALL(inverse_all_rows), METH_FASTCALL, NULL},
    {"jacobian_rows", CALL(jacobian_rows), METH_FASTCALL, NULL},
    {NULL, NULL, 0, NULL},
};

static PyGetSetDef values[] = {
    {"answers", answers, NULL, "Whether it holds a machine.", NULL},
    {"is_searched", is_searched, NULL, "Whether its inverse is a search.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};

static PyType_Slot slots[] = {
    {Py_tp_new, make},
    {Py_tp_dealloc, destroy},
    {Py_tp_methods, methods},
    {Py_tp_getset, values},
    {Py_tp_doc, "A machine in C."},
    {0, NULL},
};

static PyType_Spec type_of_machines = {
    SOFTKIN_MODULE ".Machine", sizeof(machine_object), 0, Py_TPFLAGS_DEFAULT | Py_TPFLAGS_IMMUTABLETYPE,
        slots,
};

static int fill(PyObject *module) {
  PyObject *type = PyType_FromModuleAndSpec(module, &type_of_machines, NULL);
  const int failed = PyModule_AddObjectRef(module, "Machine", type);
  Py_XDECREF(type);
  if (failed != 0 || PyModule_AddStringConstant(module, "SOURCES", SOFTKIN_SOURCES) != 0) {
    return -1;
  }
  PyObject *keys = PyTuple_New(SOFTKIN_MACHINES);
  for (int i = 0; keys != NULL && i < SOFTKIN_MACHINES; i += 1) {
    if (!put(keys, i, PyUnicode_FromString(softkin_machines[i].key))) {
      keys = drop(keys);
    }
  }
  const int unfinished = PyModule_AddObjectRef(module, "MACHINES", keys);
  Py_XDECREF(keys);
  return unfinished;
}

static PyModuleDef_Slot steps[] = {
    {Py_mod_exec, fill},
    {0, NULL},
};

static struct PyModuleDef module = {
    PyModuleDef_HEAD_INIT, SOFTKIN_MODULE, "The native core of the package.", 0, NULL, steps, NULL, NULL,
        NULL,
};

PyMODINIT_FUNC SOFTKIN_START(void) {
  return PyModuleDef_Init(&module);
}
