#!/usr/bin/env python3
"""The device of `softland tune` for a waveform generator and an oscilloscope that speak SCPI over TCP.

Reads shots from standard input, one JSON object a line; for each it uploads the waveform, arms the oscilloscope, triggers the
generator, reads the voltage across the contact back and answers with its edges. docs/tune.md has the lines.

The contact carries a small current from a supply through a resistor: the voltage across it is low while it is closed. Channel 1
of the generator drives the switch through an amplifier and triggers the oscilloscope, whose channel 1 sees the contact.

The commands are those of many instruments of Keysight (33500B, InfiniiVision): change Generator and Oscilloscope for yours.
"""

import argparse
import json
import math
import socket
import sys


class Instrument:
    """Lines of SCPI over a TCP socket, which most instruments offer at port 5025."""

    def __init__(self, address, timeout):
        host, _, port = address.partition(":")
        self.socket = socket.create_connection((host, int(port or 5025)), timeout=timeout)
        self.stream = self.socket.makefile("rb")

    def tell(self, command, payload=b""):
        self.socket.sendall(command.encode("ascii") + payload + b"\n")

    def ask(self, command):
        self.tell(command)
        return self.stream.readline().decode("ascii").strip()

    def ask_block(self, command):
        """The bytes of a block of definite length (IEEE 488.2): #, number of digits, length, bytes."""
        self.tell(command)
        if self.stream.read(1) != b"#":
            raise ValueError(f"{command}: the answer is no block")
        length = int(self.stream.read(int(self.stream.read(1))))
        block = self.stream.read(length)
        self.stream.readline()
        return block

    def check(self):
        """Raises where the instrument has something to complain of."""
        error = self.ask("SYST:ERR?")
        if not error.startswith(("+0", "0")):
            raise ValueError(error)


class Generator(Instrument):
    """Plays an arbitrary waveform once at every trigger from the bus, and holds its last sample."""

    def load(self, volts, sample_rate, amplifier):
        """volts: samples at the switch; the amplifier multiplies what the generator gives."""
        top = max(max(abs(v) for v in volts) / amplifier, 1e-3)
        codes = [round(32767 * v / amplifier / top) for v in volts]
        data = b"".join(code.to_bytes(2, "big", signed=True) for code in codes)
        length = str(len(data))
        self.tell("SOUR1:DATA:VOL:CLE")
        self.tell(f"SOUR1:DATA:ARB:DAC softland,#{len(length)}{length}", data)
        self.tell("SOUR1:FUNC:ARB softland")
        self.tell("SOUR1:FUNC ARB")
        self.tell(f"SOUR1:FUNC:ARB:SRAT {sample_rate:.9g}")
        self.tell(f"SOUR1:VOLT:HIGH {top:.9g};LOW {-top:.9g}")
        self.tell("SOUR1:BURS:MODE TRIG;NCYC 1")
        self.tell("SOUR1:BURS:STAT ON")
        self.tell("TRIG1:SOUR BUS")
        self.tell("OUTP1 ON")
        self.check()

    def trigger(self):
        self.tell("*TRG")


class Oscilloscope(Instrument):
    """Records one channel from the trigger on."""

    def arm(self, duration):
        self.tell(f":TIM:RANG {duration:.9g}")
        self.tell(":TIM:REF LEFT")
        self.tell(":WAV:SOUR CHAN1")
        self.tell(":WAV:FORM WORD")
        self.tell(":WAV:UNS OFF")
        self.tell(":WAV:BYT MSBF")
        self.tell(":SING")
        self.check()
        self.ask("*OPC?")

    def record(self):
        """Times [s] since the trigger and voltages [V]."""
        preamble = [float(number) for number in self.ask(":WAV:PRE?").split(",")]
        step, first, reference, scale, zero, middle = preamble[4:10]
        block = self.ask_block(":WAV:DATA?")
        codes = [int.from_bytes(block[i : i + 2], "big", signed=True) for i in range(0, len(block) - 1, 2)]
        return [(first + (i - reference) * step, zero + (code - middle) * scale) for i, code in enumerate(codes)]


def samples(drive, sample_rate, duration):
    """The straight lines of a drive at k / sample_rate; of two rows of the same time the later one holds from then on."""
    times, volts = drive["time_s"], drive["V"]
    out, row = [], 0
    for k in range(math.ceil(duration * sample_rate - 1e-6) + 1):
        time = k / sample_rate
        while row + 1 < len(times) and times[row + 1] <= time:
            row += 1
        if row + 1 == len(times):
            out.append(volts[row])
        else:
            part = (time - times[row]) / (times[row + 1] - times[row])
            out.append(volts[row] + part * (volts[row + 1] - volts[row]))
    return out


def edges(record, open_voltage, closed_voltage):
    """When the contact closes and opens. Thresholds apart by a third of the way keep noise from being taken for bounces; the time
    of an edge is where the straight line between two samples passes the middle."""
    low = closed_voltage + (open_voltage - closed_voltage) / 3
    high = closed_voltage + 2 * (open_voltage - closed_voltage) / 3
    middle = (low + high) / 2
    found, closed, crossing, before = [], False, 0.0, None
    for time, volts in record:
        if before and (before[1] - middle) * (volts - middle) <= 0 and before[1] != volts:
            crossing = before[0] + (time - before[0]) * (middle - before[1]) / (volts - before[1])
        if time >= 0 and (volts < low if not closed else volts > high):
            closed = not closed
            found.append([max(crossing, 0.0), int(closed)])
        before = (time, volts)
    return found


def fire(shot, generator, oscilloscope, options):
    if list(shot["drives"]) != [options.drive]:
        raise ValueError(f"the drives are {', '.join(shot['drives'])}; this generator gives {options.drive} alone")
    drive = shot["drives"][options.drive]
    duration = drive["time_s"][-1] + shot["hold_s"]
    amplifier = options.amplifier or drive.get("amplifier", 1)
    generator.load(samples(drive, options.sample_rate, duration), options.sample_rate, amplifier)
    oscilloscope.arm(duration)
    generator.trigger()
    return edges(oscilloscope.record(), options.open_voltage, options.closed_voltage)


def main():
    parser = argparse.ArgumentParser(description="The device of `softland tune` for instruments that speak SCPI over TCP.")
    parser.add_argument("--generator", required=True, metavar="HOST[:PORT]")
    parser.add_argument("--oscilloscope", required=True, metavar="HOST[:PORT]")
    parser.add_argument("--drive", default="main", help="the electrode that the generator drives (default: main)")
    parser.add_argument("--sample-rate", type=float, default=50e6, help="of the generator [1/s] (default: 50e6)")
    parser.add_argument("--amplifier", type=float, help="voltage at the switch over that of the generator (default: what [driver] says, or 1)")
    parser.add_argument("--open-voltage", type=float, default=1.0, help="across the open contact [V] (default: 1)")
    parser.add_argument("--closed-voltage", type=float, default=0.0, help="across the closed contact [V] (default: 0)")
    parser.add_argument("--timeout", type=float, default=10, help="for an answer of an instrument [s] (default: 10)")
    options = parser.parse_args()
    generator = Generator(options.generator, options.timeout)
    oscilloscope = Oscilloscope(options.oscilloscope, options.timeout)
    for line in sys.stdin:
        shot = json.loads(line)
        if shot.get("done"):
            break
        answer = {"shot": shot["shot"]}
        try:
            answer["edges_s"] = fire(shot, generator, oscilloscope, options)
        except (OSError, ValueError) as error:
            answer["error"] = str(error) or type(error).__name__
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
