"""Files as recorders and programs write them, read to the pulses they hold.

Pulses at two contacts, in N or in volts of 12.5 N, each microsecond, with noise of half a percent.
"""

import json
import math
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from tests.commands import ended
from validation import cli
from validation.scenes.checks import SceneError
from validation.studies.records import pulses

ARRIVALS = {8: 2.5e-4, 14: 4.3e-4}  # in s, from the blow
PEAKS = {8: 41.2, 14: 40.9}  # in N
WIDTH = 55e-6  # FWHM in s
SPACING = 19.05e-3
CLOCK = 1_764_237_753  # s
TRIGGER = 1.9e-4  # time at which the clock of the recorder is 0
CONSTANT = 1e-3  # of a sensor that loses its charge


@pytest.fixture(scope="module")
def record():
    """Times by the recorder's clock, and noisy forces at both contacts: Gaussian pulses."""
    rng = np.random.default_rng(2)
    t = np.linspace(0, 7e-4, 701)
    forces = []
    for contact, peak in PEAKS.items():
        x = (t - ARRIVALS[contact]) / WIDTH
        noise = 0.005 * peak * rng.normal(size=len(t))
        forces.append(peak * np.exp(-4 * math.log(2) * x**2) + noise)
    return t - TRIGGER, np.array(forces)


# Head of a file; forms of its rows, of which the last is that of all further rows (i the number, t
# the time in s, us the time in µs, a and b volts, F and G forces, Q the force behind a sensor that
# loses its charge); and what is stated on the command line.
V_AB = " --unit '8 force=12.5 N/V' --unit '14 force=12.5 N/V'"
AB_23 = "--column '8 force=2' --column '14 force=3'"
LAYOUTS = {
    "a unit in words": (
        "Time (Microseconds),Force (N)\n",
        "{us:.3f},{F:.5f}\n",
        "--column '8 force=2'",
    ),
    "a second header in words": (
        "time,force\ntime - seconds (computed after test),N\n",
        "{t:.7f},{F:.5f}\n",
        "--column '8 force=2' --unit time=s --unit 2=N",
    ),
    "an acceleration": (
        "Time (s),a (m/s^2)\n",
        "{t:.7f},{a:.5f}\n",
        "--column '8 force=2' --unit '8 force=12.5 N/m/s^2'",
    ),
    "no header": (
        "",
        "{t:.7f},{F:.5f}\n",
        "--column time=1 --column '8 force=2' --unit time=s --unit '8 force=N'",
    ),
    "blanks": ("# time(us) force(N)\n", "{us:.9e} {F:.9e}\n", "--column '8 force=2'"),
    "a footer": (
        "time (s),F1 (N),F2 (N)\n",
        "{t:.7f},{F:.5f},{G:.5f}\n",
        AB_23,
    ),
    "a sensor that loses its charge": (
        "time (s),F1 (N)\n",
        "{t:.7f},{Q:.5f}\n",
        "--column '8 force=F1' --time-constant 1ms",
    ),
    "a data frame": (
        ",time (s),8 force (N),14 force (N)\n",
        "{i},{t:.9g},{F:.9g},{G:.9g}\n",
        "",
    ),
    "a time for each channel": (
        "Time (s)\tDev1/ai0 (V)\tTime (s)\tDev1/ai1 (V)\n",
        "{t:.7f}\t{a:.6f}\t{t:.7f}\t{b:.6f}\n",
        "--column '8 force=Dev1/ai0' --column '14 force=Dev1/ai1'" + V_AB,
    ),
    "a logger in German": (
        "Zeit [µs];Kraft A [N];Kraft B [kN]\r\n",
        "{us:.6f};{F:.6f};{G:.6f}e-3\r\n",
        "--column time=1 " + AB_23,
    ),
    "decimal commas in quotes": (
        '"Zeit (s)","Kraft (N)"\n',
        '"{t:.7f}","{F:.4f}"\n',
        "--column time=Zeit --column '8 force=Kraft'",
    ),
    # Equal names, a unit for a header
    "Siglent SDS1000X-E": (
        "Record Length,Analog:701\nVertical Units,CH1:V,CH2:V,,\nSource,CH1,CH2\n"
        "Second,Volt,Volt\n",
        "{t:.11f},{a:.5f},{b:.5f}\n",
        "--column time=1 --unit time=s " + AB_23 + V_AB,
    ),
    # Numbers of samples; start and step stand in the header.
    "Rigol DS1000Z": (
        "X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,-1.900000e-04,1.000000e-06,\n",
        "{i},{a:.4e},{b:.4e},\n",
        "--step '1 us' " + AB_23 + V_AB,
    ),
    "PicoScope": (
        "Time,Channel A,Channel B\n(us),(mV),(mV)\n\n",
        "{us:.6f},{a:.7f}e3,{b:.7f}e3\n",
        AB_23 + V_AB.replace("12.5 N/V", "0.0125 N/mV"),
    ),
    # Settings stand in the first columns (mamclain.com, Tektronix TPS2024).
    "Tektronix TDS2000": (
        "",
        "Record Length,7.01e+02,, {t:.9f}, {a:.5f},\n",
        "Source,CH1,, {t:.9f}, {a:.5f},\n",
        ",,,{t:013.9f}, {a:.5f},\n",
        "--column time=4 --column '8 force=5' --unit time=s --unit 5='12.5 N/V'",
    ),
    "LeCroy": (
        "LECROYHDO6104,1234,Waveform\nSegments,1,SegmentSize,701\nSegment,TrigTime,Time\n"
        "#1,23-Nov-2026 10:11:12,0\nTime,Ampl\n",
        "{t:.7f},{a:.5f}\n",
        "--column '8 force=ampl' --unit Ampl='12.5 N/V' --unit time=s",
    ),
    # X_Columns No: the step is that of the header (ni.com, specification of .lvm).
    "LabVIEW without X": (
        "LabVIEW Measurement\t\nWriter_Version\t2\n***End_of_Header***\t\n\t\n"
        "Samples\t701\t701\t\nDate\t2026/11/27\t2026/11/27\t\nX0\t0\t0\t\nDelta_X\t1E-6\t1E-6\t\n"
        "***End_of_Header***\t\t\nX_Value\tVoltage\tVoltage (Filtered)\tComment\n",
        "\t{a:.6f}\t{b:.6f}\tblow 1, hit\n",
        "\t{a:.6f}\t{b:.6f}\n",
        "--column '8 force=Voltage' --column '14 force=3' --step 1us" + V_AB,
    ),
    # Numbers with other numbers, and lines without any, between them and the record (DL series)
    "Yokogawa": (
        '//YOKOGAWA ASCII FILE FORMAT\n"Header Size",9\n"TraceName","CH1  ","CH2  "\n'
        '"BlockSize",701,701\n"VUnit","V  ","V  "\n"HResolution",1.0e-06,1.0e-06\n'
        '"Date","2026/11/27","2026/11/27"\n\n',
        ",{a:.6E},{b:.6E},\n",
        "--column '8 force=CH1' --column '14 force=CH2' --step 1us" + V_AB,
    ),
    "Rohde & Schwarz": (
        "in s,C1 in V,C2 in V\n",
        "{t:.7f},{a:.5f},{b:.5f}\n",
        "--column time=1 --column '8 force=C1' --column '14 force=C2'" + V_AB,
    ),
    # GL980: dates, and a blank behind a sign
    "Graphtec": (
        'Vendor,"GRAPHTEC Corporation"\nMaxChannel,8\nSampling interval,1us\nCH,Signal name,Unit\n'
        "CH3,U,V\nData\nNumber,Date,Time,us,CH3,CH4\nNO.,Time,,us,V,V\n",
        "{i},2026/11/27,10:11:12,0,{a:+.5f},{b:+.5f}\n",
        "--column '8 force=5' --column '14 force=CH4' --step 1us" + V_AB,
    ),
    # By blanks the header has more numbers than the record has.
    "catman": (
        "catman\tV5\nTime  1 - default sample rate 1 MHz [s]\tForce A [N]\tForce B [N]\n",
        "{t:.7f}\t{F:.4f}\t{G:.4f}\n",
        "--column time=1 --column '8 force=Force A' --column '14 force=Force B'",
    ),
    # Its clock began in 1970.
    "DEWESoft": (
        "Data info\nFile name: x.dxd\nSample rate: 1E6\n\n\nData1\n\nTime (s),AI 1 (N),AI 2 (N)\n",
        "{late:.7f},{F:.6f},{G:.6f}\n",
        "--column time=Time " + AB_23,
    ),
    # Headers of several words stand apart by several blanks.
    "COMSOL": (
        "% Model:              chain.mph\n% Table:              Table 1 - Global Evaluation 1\n"
        "% Time (s)               Contact force 8 (N)      Contact force 14 (N)\n",
        "{t:<24.16g} {F:<24.16g} {G:<24.16g}\n",
        "--column '8 force=Contact force 8' --column '14 force=3'",
    ),
    "Fortran": (
        "",
        "  {t:.9E}  {F:.9E}\n",
        "--column time=1 --column '8 force=2' --unit time=s --unit 2=N",
    ),
    # The layouts below are those that public programs read or write, named with them.
    # A channel may begin later (readers of CSV files of InfiniiVision oscilloscopes).
    "Keysight": (
        "x-axis,1,2\nsecond,Volt,Volt\n",
        "{t:.6E},,\n",
        "{t:.6E},{a:+.6E},{b:+.6E}\n",
        "--column time=1 --unit time=s " + AB_23 + V_AB,
    ),
    # One channel, without times (the class TWaveform, a reader of files of GDS oscilloscopes)
    "GW Instek": (
        "Memory Length,701,\nTrigger Level,-2.40000e+01,\nSource,CH2,\nProbe,1.0X,\n"
        "Vertical Units,V,\nHorizontal Units,S,\nSampling Period,1.00000e-06,\nWaveform Data,\n",
        "{a:.5f},\n",
        "--column '8 force=1' --step 1us --unit '8 force=12.5 N/V'",
    ),
    # Notes that look like comments (Scope-Analyser, of a DSO5202P)
    "Hantek": (
        "#timebase=20000000(ps)\n,#voltbase=1000000(uV)\n#size=701\n",
        "{t:.5E},{a:.3f}\n",
        "--column time=1 --unit time=s --column '8 force=2' --unit 2='12.5 N/V'",
    ),
    # glscopeclient, import of CSV files
    "Digilent WaveForms": (
        "#Digilent WaveForms Oscilloscope Acquisition\n#Sample rate: 1e6Hz\n#Samples: 701\n\n"
        "Time (s),Channel 1 (V),Channel 2 (V)\n",
        "{t:.7f},{a:.6f},{b:.6f}\n",
        "--column '8 force=Channel 1' --column '14 force=Channel 2'" + V_AB,
    ),
    # A reader of files of an MDO4014B
    "Tektronix MDO4000": (
        "Model,MDO4014B-3\nFirmware Version,3.22\n\nHorizontal Units,s\nSample Interval,1e-06\n"
        "Record Length,701\nVertical Units,V\nVertical Position,-3.76\n,\n,\nLabel,\nTIME,CH2\n",
        "{t:.10e},{a:.5f}\n",
        "--unit time=s --column '8 force=CH2' --unit CH2='12.5 N/V'",
    ),
    # bidsphysio and popp, readers of LabChart's text
    "ADInstruments": (
        "Interval=\t1e-06 s\nExcelDateTime=\t4.37494e+04\t10/11/19 11:08:37.485584\n"
        "ChannelTitle=\tPulse\tVolume\nRange=\t2.000 V\t50.0 mV\nTopValue=\t*\t56.44\n",
        "{t:.7f}\t{a:.6f}\t{b:.6f}\n",
        "--column time=1 --unit time=s " + AB_23 + V_AB,
    ),
    # Logger Pro, by a German reader
    "Vernier": (
        "Latest: Time (s);Latest: Potential 1 (V);Latest: Potential 2 (V)\n",
        "{t:.7f};{a:.6f};{b:.6f}\n",
        "--column time=1 " + AB_23 + V_AB,
    ),
    # Numbers of samples from 1 (the comments of an importer by ElmüSoft)
    "OWON": (
        "Unit:(mV)\n,CH1\nFrequency,866.567 Hz\nPeriod,1.154 ms\n",
        "{i},{a:.5f}e3\n",
        "--column '8 force=CH1' --step 1us --unit '8 force=0.0125 N/mV'",
    ),
}


def written(layout, record):
    """Write the record in a layout to the folder; return the file's name."""
    time, forces = record
    head, *forms, _ = LAYOUTS[layout]
    kept = math.exp(-1e-6 / CONSTANT)
    lost = lfilter(math.sqrt(kept) * np.array([1, -1]), [1, -kept], forces[0])
    text = head
    for i, row in enumerate(zip(time, *forces / 12.5, *forces, lost, strict=True)):
        numbers = dict(zip("tabFGQ", row, strict=True))
        form = forms[min(i, len(forms) - 1)]
        numbers |= {"i": i, "us": 1e6 * row[0], "late": CLOCK + row[0]}
        text += form.format(**numbers)
    if layout == "a footer":
        text += "End of data,,\n"
    if layout in ("a logger in German", "decimal commas in quotes", "Vernier"):
        text = text.replace(".", ",")
    if layout == "Graphtec":
        text = re.sub(r"([-+])(\d)", r"\1 \2", text)
    if layout == "Fortran":
        text = text.replace("E", "D")
    file = Path("record.txt")
    file.write_bytes(text.encode("latin-1"))
    return str(file)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_pulses_are_read_within_three_errors(capsys, record, folder, layout):
    """A column without a kind is of the kind that is given; by a step the clock starts at 0."""
    file = written(layout, record)
    head, *_, stated = LAYOUTS[layout]
    options = ["--of", "bead", "--distance", str(SPACING), "--format", "json"]
    options += shlex.split(stated)
    status, out, err = ended(capsys, cli.main, "pulses", file, *options)
    assert status == 0, err
    found = json.loads(out)
    assert [row["kind"] for row in found["sensors"]] == ["bead"] * len(found["sensors"])
    assert len(found["sensors"]) == 1 + ("14 force" in stated + head)
    start = TRIGGER - CLOCK * (layout == "DEWESoft")
    if "--step" in stated:
        start = 0.0
    for row in found["sensors"]:
        arrival, peak = ARRIVALS[row["number"]] - start, PEAKS[row["number"]]
        for name, value, size in (
            ("arrival", arrival, WIDTH),
            ("peak", peak, peak),
            ("fwhm", WIDTH, WIDTH),
        ):
            off = row[f"{name}_value"] - value
            assert abs(off) < 3 * row[f"{name}_error_value"] < 0.03 * size, name
    for row in found["speeds"]:
        speed = 6 * SPACING / (ARRIVALS[14] - ARRIVALS[8])
        error = row["speed_error_value"]
        assert abs(row["speed_value"] - speed) < 3 * error < 0.02 * speed


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_refusal_ends_in_the_line_that_reads_the_file(record, folder, capsys, layout):
    """At most two lines are pasted; a gap or a name that is not there needs the user's own word."""
    line = ["pulses", written(layout, record)]
    refused = []
    status = 2
    while status == 2 and len(refused) < 3:
        status, _, err = ended(capsys, cli.main, *line)
        if status == 2:
            reason, _, proposed = err.partition("; try: ")
            assert reason not in refused
            refused.append(reason)
            assert proposed, err
            _, *line = shlex.split(proposed)
    assert status == 0, refused


def test_sensors_without_numbers_are_numbered_in_the_order_of_files_and_columns(
    record, tmp_path
):
    time, forces = record
    first, second, both = (tmp_path / f"{name}.csv" for name in "abc")
    np.savetxt(first, np.c_[time, forces[0]], delimiter=",")
    np.savetxt(second, np.c_[time, forces[1]], delimiter=",")
    stated = {"columns": {"time": "1", "force": "2"}, "units": {"time": "s", "2": "N"}}
    np.savetxt(
        both, np.c_[time, *forces], "%g", ",", header="time (s),force (N),force (N)"
    )
    for files, given in (([first, second], stated), (both, {})):
        found = pulses(files, **given).document()
        assert [row["number"] for row in found["sensors"]] == [1, 2]
        peaks = [row["peak_value"] for row in found["sensors"]]
        assert peaks == pytest.approx([*PEAKS.values()], rel=0.01)
    with pytest.raises(SceneError, match="bead 3 is there twice"):
        pulses([first, second], columns={"time": "1", "bead 3 force": "2"})
