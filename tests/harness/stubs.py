"""Stand-ins for the SoftMotion libraries, and those of PacDrive: as Structured Text where that is possible.

Sizes and the storage order of the matrix are not documented, so a test can choose them.
"""

import math
from collections.abc import Callable
from typing import Any

from .faults import StFault
from .runtime import Matrix

Rows = tuple[tuple[float, ...], ...]

SM3_ERROR = """
TYPE SMC_ERROR : (
    SMC_NO_ERROR := 0, SMC_TRAFO_INVALID_COUPLING, SMC_MODULO_AXIS_FOR_NON_ROTARY_JOINT,
    SMC_MODULO_AXIS_FOR_LIMITED_ROTARY_JOINT, SMC_MODULO_AXIS_PERIOD_NOT_360,
    SMC_TRAFO_NOT_INITIALIZED, SMC_CP_ERROR_CREATING_PARAM_TRANSFORM,
    SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS, SMC_TRAFO_INVALID_CONSTELLATION
);
END_TYPE

TYPE SMC_LANGUAGE_TYPE : (FIRST, SECOND);
END_TYPE

FUNCTION SMC_ErrorString : STRING(100)
VAR_INPUT ErrorID : SMC_ERROR; Language : SMC_LANGUAGE_TYPE; END_VAR
SMC_ErrorString := '';
IF ErrorID <> SMC_ERROR.SMC_NO_ERROR THEN
  SMC_ErrorString := 'an error';
END_IF
END_FUNCTION
"""

SM3M = """
VAR_GLOBAL CONSTANT
    SMC_MAX_VEC_DIM : DINT := 6;
END_VAR
TYPE SMC_Vector3D : STRUCT dX : LREAL; dY : LREAL; dZ : LREAL; END_STRUCT END_TYPE
TYPE SMC_Frame : STRUCT mR : SMC_Matrix3; vT : SMC_Vector3D; END_STRUCT END_TYPE
{attribute 'native'}
FUNCTION SMC_Frame_Mult : BOOL
VAR_IN_OUT frDst : SMC_Frame; END_VAR
VAR_IN_OUT CONSTANT frLhs : SMC_Frame; frRhs : SMC_Frame; END_VAR
END_FUNCTION
"""

TRAFO = """
VAR_GLOBAL CONSTANT
    gciMaxConfigData : INT := {max_config_data};
END_VAR
TYPE AXISPOS_REF : STRUCT
    a0 : LREAL; a1 : LREAL; a2 : LREAL; a3 : LREAL; a4 : LREAL; a5 : LREAL;
END_STRUCT END_TYPE
TYPE CONFIGDATA : STRUCT abyData : ARRAY[0..gciMaxConfigData] OF BYTE; END_STRUCT END_TYPE
TYPE Axis_Type : (Rotary, Linear); END_TYPE
TYPE AXISLIMITS : STRUCT xUnlimited : BOOL; dLower : LREAL; dUpper : LREAL; END_STRUCT END_TYPE
TYPE Axis_Properties : STRUCT eType : Axis_Type; limits : AXISLIMITS; END_STRUCT END_TYPE
TYPE Axis_Settings : STRUCT limits : AXISLIMITS; END_STRUCT END_TYPE
{attribute 'qualified_only'}
TYPE OrientationDOF : (zero, one, three); END_TYPE
{attribute 'qualified_only'}
TYPE MCS_OR_FLANGE : (Flange, MCS); END_TYPE
TYPE OrientationSpace : STRUCT
    dof : OrientationDOF; vRot : SMC_Vector3D; mOriZero : SMC_Matrix3; vU : SMC_Vector3D;
END_STRUCT END_TYPE

FUNCTION Initialise_OriImage_dof0 : BOOL
VAR_IN_OUT oriInfo : OrientationSpace; END_VAR
VAR_IN_OUT CONSTANT mR : SMC_Matrix3; END_VAR
oriInfo.dof := OrientationDOF.zero;
oriInfo.mOriZero := mR;
Initialise_OriImage_dof0 := TRUE;
END_FUNCTION

FUNCTION Initialise_OriImage_dof1 : BOOL
VAR_IN_OUT oriInfo : OrientationSpace; END_VAR
VAR_IN_OUT CONSTANT mR : SMC_Matrix3; vU : SMC_Vector3D; vRot : SMC_Vector3D; END_VAR
oriInfo.dof := OrientationDOF.one;
oriInfo.mOriZero := mR;
oriInfo.vU := vU;
oriInfo.vRot := vRot;
Initialise_OriImage_dof1 := TRUE;
END_FUNCTION

FUNCTION Initialise_OriImage_dof3 : BOOL
VAR_IN_OUT oriInfo : OrientationSpace; END_VAR
VAR_IN_OUT CONSTANT mR : SMC_Matrix3; END_VAR
oriInfo.dof := OrientationDOF.three;
oriInfo.mOriZero := mR;
Initialise_OriImage_dof3 := TRUE;
END_FUNCTION

{attribute 'native'}
FUNCTION CAxis_From_Orientation : SMC_ERROR
VAR_IN_OUT CONSTANT mR : SMC_Matrix3; END_VAR
VAR_OUTPUT c_deg : LREAL; END_VAR
END_FUNCTION
"""

# The libraries of PacDrive, as far as a user transformation names them.
GD = """
{attribute 'qualified_only'}
TYPE ET_Diag : (Ok, InputParameterInvalid); END_TYPE
"""

PDL = """
TYPE ST_Vector3D : STRUCT lrX : LREAL; lrY : LREAL; lrZ : LREAL; END_STRUCT END_TYPE
"""

_OUTPUTS = "VAR_OUTPUT q_etDiag : GD.ET_Diag; q_etDiagExt : ROB.ET_DiagExt; q_sMsg : STRING(80);"
ROB = f"""
{{attribute 'qualified_only'}}
TYPE ET_DiagExt : (NothingMore); END_TYPE
INTERFACE IF_UserTransformation3Ax EXTENDS __SYSTEM.IQueryInterface
METHOD Direct
VAR_INPUT i_lrPositionA : LREAL; i_lrPositionB : LREAL; i_lrPositionC : LREAL; END_VAR
{_OUTPUTS} q_stCoordinate : PDL.ST_Vector3D; END_VAR
END_METHOD
METHOD Inverse
VAR_INPUT i_stRefCoordinate : PDL.ST_Vector3D; END_VAR
{_OUTPUTS} q_lrRefPositionA : LREAL; q_lrRefPositionB : LREAL; q_lrRefPositionC : LREAL; END_VAR
END_METHOD
END_INTERFACE
INTERFACE IF_UserTransformation6Ax EXTENDS __SYSTEM.IQueryInterface
METHOD Direct
VAR_INPUT
  i_lrPositionA : LREAL; i_lrPositionB : LREAL; i_lrPositionC : LREAL;
  i_lrPositionD : LREAL; i_lrPositionE : LREAL; i_lrPositionF : LREAL;
END_VAR
{_OUTPUTS} q_stCoordinate : PDL.ST_Vector3D; q_stOrientation : PDL.ST_Vector3D; END_VAR
END_METHOD
METHOD Inverse
VAR_INPUT i_stRefCoordinate : PDL.ST_Vector3D; i_stRefOrientation : PDL.ST_Vector3D; END_VAR
{_OUTPUTS}
  q_lrRefPositionA : LREAL; q_lrRefPositionB : LREAL; q_lrRefPositionC : LREAL;
  q_lrRefPositionD : LREAL; q_lrRefPositionE : LREAL; q_lrRefPositionF : LREAL;
END_VAR
END_METHOD
END_INTERFACE
"""

# OrientationSpace.vU starts as (0, 0, 1); the dialect has no initialiser for structures.
EXTRA_INITIALISATION = {"OrientationSpace": ["self.vU.dZ = 1.0"]}


def texts(max_config_data: int) -> dict[str, str]:
    """Namespace -> Structured Text, in the order in which they build on each other."""
    trafo = TRAFO.replace("{max_config_data}", str(max_config_data))
    return {"SM3_Error": SM3_ERROR, "SM3M": SM3M, "TRAFO": trafo, "GD": GD, "PDL": PDL, "ROB": ROB}


class MatrixAccess:
    """Reads and writes the opaque matrix in one storage order."""

    def __init__(self, order: str) -> None:
        if order not in ("rows", "columns"):
            raise ValueError(f"order must be rows or columns, not {order}")
        self.is_by_rows = order == "rows"

    def get(self, matrix: Matrix) -> Rows:
        a, b, c, d, e, f, g, h, i = matrix.memory[:9]
        return ((a, b, c), (d, e, f), (g, h, i)) if self.is_by_rows else ((a, d, g), (b, e, h), (c, f, i))

    def set(self, matrix: Matrix, rows: Rows) -> None:
        (a, b, c), (d, e, f), (g, h, i) = rows
        flat = (a, b, c, d, e, f, g, h, i) if self.is_by_rows else (a, d, g, b, e, h, c, f, i)
        matrix.memory[:9] = map(float, flat)


def natives(access: MatrixAccess) -> dict[str, Callable[..., Any]]:
    """The stand-ins that need the fields of the matrix, by lower-case name."""

    def frame_mult(destination: Any, left: Any, right: Any) -> bool:
        a, b = access.get(left.mR), access.get(right.mR)
        t, s = _vector(left.vT), _vector(right.vT)
        rows = tuple(tuple(_finite(sum(a[i][k] * b[k][j] for k in range(3))) for j in range(3)) for i in range(3))
        moved = [_finite(t[i] + sum(a[i][k] * s[k] for k in range(3))) for i in range(3)]
        access.set(destination.mR, rows)
        destination.vT.dX, destination.vT.dY, destination.vT.dZ = moved
        return True

    def c_axis(matrix: Any, output: Any = None) -> str:
        r = access.get(matrix)
        angle = _finite(math.degrees(math.atan2(r[1][0] - r[0][1], r[0][0] + r[1][1])))
        if output is not None:
            output.value = angle
        return "SMC_NO_ERROR"

    return {"smc_frame_mult": frame_mult, "caxis_from_orientation": c_axis}


def _vector(vector: Any) -> tuple[float, float, float]:
    return vector.dX, vector.dY, vector.dZ


def _finite(value: float) -> float:
    if not math.isfinite(value):
        raise StFault(f"real result {value} of a library function is not finite")
    return value
