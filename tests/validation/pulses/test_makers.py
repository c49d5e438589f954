"""Files as recorders and programs write them, read to the pulses they hold.

Two contacts of a chain, in N or in volts of 12.5 N, each microsecond, with noise of half a percent.
"""

import re

import numpy as np
import pytest

from validation import Scene, simulate
from validation.pulses.pulse import first_pulse
from validation.scenes.checks import SceneError
from validation.studies.records import pulses

CONTACTS = (8, 14)
SPACING = 19.05e-3
TRIGGER = 1.9e-4  # time at which the clock of the recorder is 0
VOLTS = "12.5 N/V"


@pytest.fixture(scope="module")
def chain():
    """Times and noisy forces at both contacts, and the pulses without noise."""
    scene = Scene(
        masses=(29e-3,) * 24,
        stiffnesses=(9.4e9,) * 23,
        k=1.5,
        duration=7e-4,
        velocities=(0.5,),
        contact_sensors=tuple(i - 1 for i in CONTACTS),
    )
    run = simulate(scene)
    signals = [run.signal("contact", i) for i in scene.contact_sensors]
    t = np.linspace(0, scene.duration, 701)
    forces = np.array([signal(t) for signal in signals])
    noise = 0.005 * forces.max() * np.random.default_rng(2).normal(size=forces.shape)
    return t - TRIGGER, forces + noise, [first_pulse(signal) for signal in signals]


# Head of a file, form of its rows (i the number, t the time in s, us the time in µs, a and b volts,
# F and G forces), and statements; columns by header or number.
TIME_A = {"time": "1", "8 force": "2"}
TIME_AB = {"time": "1", "8 force": "2", "14 force": "3"}
A = {"8 force": VOLTS}
AB = A | {"14 force": VOLTS}
LAYOUTS = {
    "Tektronix MDO3000": (
        "Model,MDO3024\nFirmware Version,1.30\n\nHorizontal Units,s\nSample Interval,1e-06\n"
        "Vertical Units,V,V\nVertical Scale,0.5,0.5\n\nLabel,,\nTIME,CH1,CH2\n",
        "{t:.6e},{a:.5f},{b:.5f}\n",
        {"columns": {"8 force": "CH1", "14 force": "CH2"}, "units": AB | {"time": "s"}},
    ),
    # Settings stand in the first columns (mamclain.com, Tektronix TPS2024).
    "Tektronix TDS2000": (
        "",
        "Record Length,7.01e+02,, {t:.9f}, {a:.5f},\n",
        "Source,CH1,, {t:.9f}, {a:.5f},\n",
        ",,,{t:013.9f}, {a:.5f},\n",
        {"columns": {"time": "4", "8 force": "5"}, "units": A | {"time": "s"}},
    ),
    # Each value is followed by a comma (TDS3000 programmer manual).
    "Tektronix TDS3000": ("", "{t:.7e},{F:.5e},\r\n", {"columns": TIME_A}),
    "LeCroy": (
        "LECROYHDO6104,1234,Waveform\nSegments,1,SegmentSize,701\nSegment,TrigTime,Time\n"
        "#1,23-Nov-2026 10:11:12,0\nTime,Ampl\n",
        "{t:.7f},{a:.5f}\n",
        {"columns": {"8 force": "ampl"}, "units": {"Ampl": VOLTS, "time": "s"}},
    ),
    "Keysight": (
        "x-axis,1,2\r\nsecond,Volt,Volt\r\n",
        "{t:+.6E},{a:+.5E},{b:+.5E}\r\n",
        {"columns": TIME_AB, "units": {"2": "12.5 N/Volt", "3": "12.5 N/Volt"}},
    ),
    "LabVIEW": (
        "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\t\nSamples\t701\t701\t\n"
        "***End_of_Header***\t\t\nX_Value\tVoltage\tVoltage_0\tComment\n",
        "{t:.7f}\t{a:.6f}\t{b:.6f}\n",
        {"columns": TIME_AB, "units": AB | {"time": "s"}},
    ),
    # X_Columns No: the step is that of the header (ni.com, specification of .lvm).
    "LabVIEW without X": (
        "Separator\tTab\n***End_of_Header***\t\n\t\nSamples\t701\t701\t\nX0\t0\t0\t\n"
        "Delta_X\t1E-6\t1E-6\t\n***End_of_Header***\t\t\nX_Value\tVoltage\tVoltage_0\tComment\n",
        "\t{a:.6f}\t{b:.6f}\n",
        {"columns": dict(list(TIME_AB.items())[1:]), "units": AB, "step": "1 us"},
    ),
    "PicoScope": (
        "Time,Channel A,Channel B\n(us),(mV),(mV)\n\n",
        "{us:.6f},{a:.7f}e3,{b:.7f}e3\n",
        {"columns": TIME_AB, "units": dict.fromkeys(AB, "0.0125 N/mV")},
    ),
    "Rohde & Schwarz": (
        "in s,C1 in V,C2 in V\n",
        "{t:.7f},{a:.5f},{b:.5f}\n",
        {"columns": {"time": "in s", "8 force": "C1", "14 force": "C2"}, "units": AB},
    ),
    # MR8880 manual, appendix 4: ratios and offsets above the channels
    "Hioki": (
        '"File name","WAVE0001.CSV","V1.00"\n"CH","CH1","CH2","LA1"\n"Range","5V","5V","-"\n'
        '"Ratio"," 1.00000E+00"," 1.00000E+00","-"\n"Time","CH1[V]","CH2[V]","LA1"\n',
        "{t:.9E},{a: .5E},{b: .5E},1,\n",
        {
            "columns": {"8 force": "CH1[V]", "14 force": "3"},
            "units": AB | {"time": "s"},
        },
    ),
    # HDS242 (github.com/h-elsner/OwonOszi): numbers of samples, units by an underscore
    "Owon": (
        "Channel\t:,CH1\nFrequency\t:,F=1.498kHz\nProbe attenuation\t:,1X\n"
        "Time interval\t:,1.00uS\n\nindex,CH1_Voltage(mV)\n",
        "{i},{a:.7f}e3\n",
        {"columns": {"8 force": "2"}, "units": {"2": "0.0125 N/mV"}, "step": "1.00uS"},
    ),
    # DSO5202P (github.com, Scope-Analyser): no header
    "Hantek": (
        "#timebase=100000000(ps)\n,#voltbase=1000000(uV)\n#size=701\n",
        "{t:.6E},{a:.5f}\n",
        {"columns": TIME_A, "units": A | {"time": "s"}},
    ),
    "Digilent": (
        "#Digilent WaveForms Oscilloscope Acquisition\n#Sample rate: 1000000Hz\n#Samples: 701\n\n"
        "Time (s),Channel 1 (V),Channel 2 (V)\n",
        "{t:.9f},{a:.5f},{b:.5f}\n",
        {"columns": {"8 force": "Channel 1", "14 force": "3"}, "units": AB},
    ),
    # GL980: dates, and a blank behind a sign
    "Graphtec": (
        'Vendor,"GRAPHTEC Corporation"\nMaxChannel,8\nSampling interval,1us\nCH,Signal name,Unit\n'
        "CH3,U,V\nData\nNumber,Date,Time,us,CH3,CH4\nNO.,Time,,us,V,V\n",
        "{i},2026/11/27,10:11:12,0,{a:+.5f},{b:+.5f}\n",
        {"columns": {"8 force": "5", "14 force": "CH4"}, "units": AB, "step": "1us"},
    ),
    "a logger in German": (
        "Zeit [µs];Kraft A [N];Kraft B [kN]\r\n",
        "{us:.6f};{F:.6f};{G:.6f}e-3\r\n",
        {"columns": TIME_AB},
    ),
    "a time for each channel": (
        "Time (s)\tDev1/ai0 (V)\tTime (s)\tDev1/ai1 (V)\n",
        "{t:.7f}\t{a:.6f}\t{t:.7f}\t{b:.6f}\n",
        {"columns": {"8 force": "Dev1/ai0", "14 force": "Dev1/ai1"}, "units": AB},
    ),
    "a data frame": (
        ",time (s),8 force (N),14 force (N)\n",
        "{i},{t:.9g},{F:.9g},{G:.9g}\n",
        {},
    ),
    "numpy.savetxt": (
        "# time (us) force (N)\n",
        "{us:.18e} {F:.18e}\n",
        {"columns": {"8 force": "force"}},
    ),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_pulses_are_read_within_three_errors(chain, tmp_path, layout):
    """A column without a kind is of the kind that is given; by a step the clock starts at 0."""
    time, forces, true = chain
    head, *forms, stated = LAYOUTS[layout]
    rows = zip(time, *forces / 12.5, *forces, strict=True)
    text = head
    for i, (t, a, b, F, G) in enumerate(rows):
        form = forms[min(i, len(forms) - 1)]
        text += form.format(i=i, t=t, us=1e6 * t, a=a, b=b, F=F, G=G)
    if "German" in layout:
        text = text.replace(".", ",")
    if layout == "Graphtec":
        text = re.sub(r"([-+])(\d)", r"\1 \2", text)
    file = tmp_path / "record.txt"
    file.write_bytes(text.encode("latin-1"))
    found = pulses(file, distance=SPACING, of="bead", **stated).document()
    assert [row["kind"] for row in found["sensors"]] == ["bead"] * len(found["sensors"])
    assert len(found["sensors"]) == 1 + any(
        "{b" in form or "{G" in form for form in forms
    )
    start = time[0] + TRIGGER if "step" in stated else TRIGGER
    for row in found["sensors"]:
        pulse = true[CONTACTS.index(row["number"])]
        wanted = (pulse.arrival - start, pulse.peak, pulse.fwhm)
        sizes = (pulse.fwhm, pulse.peak, pulse.fwhm)
        for name, value, size in zip(
            ("arrival", "peak", "fwhm"), wanted, sizes, strict=True
        ):
            off = row[f"{name}_value"] - value
            assert abs(off) < 3 * row[f"{name}_error_value"] < 0.03 * size, name
    for row in found["speeds"]:
        speed = 6 * SPACING / (true[1].arrival - true[0].arrival)
        error = row["speed_error_value"]
        assert abs(row["speed_value"] - speed) < 3 * error < 0.02 * speed


def test_one_file_a_channel(chain, tmp_path):
    """Sensors without a number are numbered in the order of the files."""
    time, forces, true = chain
    files = []
    for name, force in zip(("F0CH1.CSV", "F0CH2.CSV"), forces, strict=True):
        files.append(tmp_path / name)
        np.savetxt(files[-1], np.c_[time, force], delimiter=",")
    stated = {"columns": {"time": "1", "force": "2"}, "units": {"time": "s", "2": "N"}}
    found = pulses(files, **stated).document()
    assert [row["number"] for row in found["sensors"]] == [1, 2]
    peaks = [row["peak_value"] for row in found["sensors"]]
    assert peaks == pytest.approx([pulse.peak for pulse in true], rel=0.01)
    with pytest.raises(SceneError, match="bead 3 is there twice"):
        pulses(files, columns={"time": "1", "bead 3 force": "2"})
