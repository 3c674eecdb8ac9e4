"""Refusals and faults by number, as `docs/src/faults.md` numbers them."""

import enum


class Refused(enum.IntEnum):
    """Why a command was refused. The value is the one on the wire, one less than the number."""

    WRONG_STATE = 0
    NO_UPLOAD = 1
    TOO_MANY_STEPS = 2
    STEPS_OUT_OF_SEQUENCE = 3
    PROGRAM_INCOMPLETE = 4
    PROGRAM_CHECKSUM = 5
    PROGRAM_EMPTY = 6
    UNKNOWN_CHANNEL = 7
    CHANNEL_TAKEN = 8
    HINGE_TAKEN = 9
    ORDER_VIOLATED = 10
    STEP_OVER_TEMPERATURE = 11
    STEP_OVER_ON_TIME = 12
    STEP_OVER_CURRENT = 13
    RIG_MISMATCH = 14
    RUN_MISMATCH = 15
    LIMIT_ABOVE_CEILING = 16
    LIFETIME_TOO_LONG = 17
    STOP_PRESSED = 18
    SERVO_RANGE = 19
    UNREADABLE = 20
    NOT_STORED = 21
    STORING = 22
    PULSE_DUTY = 23
    CALIBRATED_CURRENT = 24
    CALIBRATED_GAIN = 25
    CALIBRATED_TARGET = 26
    CALIBRATION_VALUE = 27


class Faulted(enum.IntEnum):
    """Why everything was turned off. The value is the one on the wire, one less than the number."""

    LINK_LOST = 0
    STOPPED = 1
    STOP_BUTTON = 2
    SESSION_ENDED = 3
    ARM_EXPIRED = 4
    OVER_TEMPERATURE = 5
    ON_TOO_LONG = 6
    SENSOR_OPEN = 7
    SENSOR_SHORTED = 8
    SENSOR_JUMPED = 9
    NO_GAIN = 10
    UNEXPECTED_HEAT = 11
    OVER_CURRENT = 12
    SENSOR_FROZEN = 13
    NO_COOLING = 14
    UNPLANNED_CURRENT = 15
    SERVOS_LOST = 16
