"""Records in the styles of makers of oscilloscopes and loggers, read to the pulses they hold.

Two contacts of a chain, in N or in volts of 12.5 N, each microsecond, with noise of half a percent.
"""

import numpy as np
import pytest
import scipy

from validation.studies.records import pulses

N, MASS, A = 24, 29e-3, 9.4e9  # steel spheres of 19.05 mm
CONTACTS, CALIBRATION, SPACING = (8, 14), 12.5, 19.05e-3
TRIGGER = 1.9e-4  # time at which the clock of the recorder is 0


@pytest.fixture(scope="module")
def chain():
    """SciPy's times and forces of both contacts, and arrival, peak and FWHM of their pulses."""

    def forces(y):
        return A * np.maximum(y[:-1] - y[1:], 0) ** 1.5

    def rates(t, state):
        push = np.concatenate(([0.0], forces(state[:N]), [0.0]))
        return np.concatenate((state[N:], -np.diff(push) / MASS))

    start = np.zeros(2 * N)
    start[N] = 0.5
    fine = np.linspace(0, 7e-4, 70_001)
    found = scipy.integrate.solve_ivp(
        rates, (0, fine[-1]), start, "DOP853", t_eval=fine, rtol=1e-10, atol=1e-14
    )
    rows = np.array([forces(y) for y in found.y[:N].T]).T[[i - 1 for i in CONTACTS]]
    true = []
    for row in rows:
        above = fine[row > row.max() / 2]
        true.append((fine[row.argmax()] - TRIGGER, row.max(), above[-1] - above[0]))
    noise = 0.005 * rows.max() * np.random.default_rng(2).normal(size=(2, 701))
    return fine[::100] - TRIGGER, rows[:, ::100] + noise, true


def lines(*columns, mark=",", form="{:.6e}", end="\n"):
    return (
        end.join(mark.join(map(form.format, row)) for row in zip(*columns, strict=True))
        + end
    )


VOLTS = "12.5 N/V"
AB = "CH1", "CH2"


def tektronix(t, F, V):
    head = "Model,MDO3024\nFirmware Version,1.30\n\nHorizontal Units,s\nSample Interval,1e-06\n"
    text = f"{head}Vertical Units,V,V\n\nLabel,,\nTIME,CH1,CH2\n{lines(t, *V)}"
    return text, (*AB, "TIME"), {"TIME": "s", "CH1": VOLTS, "CH2": VOLTS}


def lecroy(t, F, V):
    head = "LECROYHDO6104,1234,Waveform\nSegments,1,SegmentSize,701\nSegment,TrigTime,Time\n"
    text = f"{head}#1,23-Nov-2026 10:11:12,0\nTime,Ampl\n{lines(t, V[0])}"
    return text, ("Ampl",), {"Time": "s", "Ampl": VOLTS}


def keysight(t, F, V):
    text = "x-axis,1,2\r\nsecond,Volt,Volt\r\n" + lines(
        t, *V, form="{:+.5E}", end="\r\n"
    )
    return text, ("1", "2", "x-axis"), dict.fromkeys("12", "12.5 N/Volt")


def labview(t, F, V):
    head = "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n***End_of_Header***\t\n\t\n"
    head += "Channels\t2\t\nX_Dimension\tTime\tTime\t\n***End_of_Header***\t\t\n"
    text = f"{head}X_Value\tVoltage\tVoltage_0\tComment\n" + lines(t, *V, mark="\t")
    units = {"X_Value": "s", "Voltage": VOLTS, "Voltage_0": VOLTS}
    return text, ("Voltage", "Voltage_0", "X_Value"), units


def rigol(t, F, V):
    text = "Time(s),CH1(V),CH2(V),\n" + lines(t, *V).replace("\n", ",\n")
    return text, (*AB, "Time(s)"), {"CH1": VOLTS, "CH2": VOLTS}


def picoscope(t, F, V):
    text = f"Time,Channel A,Channel B\n(ms),(mV),(mV)\n\n{lines(1e3 * t, *(1e3 * V))}"
    names = "Channel A", "Channel B"
    return text, names, dict.fromkeys(names, "0.0125 N/mV")


def rohde_schwarz(t, F, V):
    units = {"in s": "s", "C1 in V": VOLTS, "C2 in V": VOLTS}
    return (
        f"in s,C1 in V,C2 in V\n{lines(t, *V)}",
        ("C1 in V", "C2 in V", "in s"),
        units,
    )


def logger_in_german(t, F, V):
    text = "Zeit [µs];Kraft A [N];Kraft B [kN]\r\n"
    text += lines(1e6 * t, F[0], F[1] / 1e3, mark=";", end="\r\n").replace(".", ",")
    return text.encode("latin-1"), ("Kraft A", "Kraft B", "Zeit"), {}


def a_time_for_each_channel(t, F, V):
    text = "Time (s)\tDev1/ai0 (V)\tTime (s)\tDev1/ai1 (V)\n" + lines(
        t, V[0], t, V[1], mark="\t"
    )
    return text, ("Dev1/ai0", "Dev1/ai1"), {"Dev1/ai0": VOLTS, "Dev1/ai1": VOLTS}


def with_a_byte_order_mark(t, F, V):
    text = '\ufeff"Data from 23.11.2026"\r\n\r\n"Time (s)","AI 1 (N)","AI 2 (N)"\r\n'
    return text + lines(t, *F, end="\r\n"), ("AI 1", "AI 2"), {}


def a_data_frame(t, F, V):
    """With a column of row numbers; the shorter channel ends in blank cells."""
    rows = lines(np.arange(len(t)), t, *F, form="{:.9g}").splitlines()
    rows[-40:] = [row.rpartition(",")[0] + "," for row in rows[-40:]]
    return ",time (s),8 force (N),14 force (N)\n" + "\n".join(rows) + "\n", (), {}


@pytest.mark.parametrize(
    "style",
    [
        *(tektronix, lecroy, keysight, labview, rigol, picoscope, rohde_schwarz),
        *(
            logger_in_german,
            a_time_for_each_channel,
            with_a_byte_order_mark,
            a_data_frame,
        ),
    ],
)
def test_pulses_are_read_within_three_errors(chain, tmp_path, style):
    """The kind of the sensors is in their names or is given."""
    time, forces, true = chain
    text, headers, units = style(time, forces, np.round(forces / CALIBRATION, 7))
    file = tmp_path / "record.csv"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    names = zip(("bead 8 force", "14 force", "time"), headers, strict=False)
    options = {"renamed": dict(names), "units": units}
    options |= {"of": "bead"} if headers else {}
    found = pulses(file, distance=SPACING, **options).document()
    assert all(row["kind"] == options.get("of", "contact") for row in found["sensors"])
    assert len(found["sensors"]) == 2 - (style is lecroy)
    for row in found["sensors"]:
        arrival, peak, fwhm = true[CONTACTS.index(row["number"])]
        sizes = {"arrival": (arrival, fwhm), "peak": (peak, peak), "fwhm": (fwhm, fwhm)}
        for name, (value, size) in sizes.items():
            off, error = row[f"{name}_value"] - value, row[f"{name}_error_value"]
            assert abs(off) < 3 * error < 0.03 * size, name
    for row in found["speeds"]:
        speed = 6 * SPACING / (true[1][0] - true[0][0])
        assert (
            abs(row["speed_value"] - speed)
            < 3 * row["speed_error_value"]
            < 0.02 * speed
        )
