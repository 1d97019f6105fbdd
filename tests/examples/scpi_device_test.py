"""examples/scpi_device.py against instruments that are simulated: what it uploads, which edges it finds, and what it says when one fails."""

import json
import re
import socketserver
import subprocess
import sys
import threading
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
EDGES = [[20.13e-6, 1], [24.4e-6, 0], [25.77e-6, 1]]  # of the contact [s]
STEP = 20e-9  # between two samples of the oscilloscope [s]
SAMPLE_RATE = 10e6  # of the generator


class Instrument(socketserver.ThreadingTCPServer):
    """Keeps the commands that it is told, and answers those that ask."""

    allow_reuse_address = daemon_threads = True

    def __init__(self):
        self.commands, self.data, self.error = [], b"", '+0,"No error"'
        super().__init__(("127.0.0.1", 0), Session)
        threading.Thread(target=self.serve_forever, args=(0.02,), daemon=True).start()

    def address(self):
        return f"127.0.0.1:{self.server_address[1]}"

    def answer(self, command):
        return {"SYST:ERR?": self.error, "*OPC?": "1"}.get(command)


class Session(socketserver.StreamRequestHandler):
    def handle(self):
        while command := self.command():
            self.server.commands.append(command)
            answer = self.server.answer(command)
            if answer is not None:
                self.wfile.write(answer if isinstance(answer, bytes) else answer.encode() + b"\n")

    def command(self):
        """A line; of a block of samples, which may hold line feeds, its bytes are kept apart."""
        line = b""
        while not line.endswith(b"\n"):
            byte = self.rfile.read(1)
            if not byte:
                return ""
            line += byte
            header = re.fullmatch(rb"SOUR1:DATA:ARB:DAC softland,#(\d)(\d+)", line)
            if header and len(header[2]) == int(header[1]):
                self.server.data = self.rfile.read(int(header[2]))
        return line.decode("ascii").strip()


class Oscilloscope(Instrument):
    """Sees 1 V while the contact is open and 0 V while it is closed, with noise."""

    def answer(self, command):
        if command == ":WAV:PRE?":
            return f"1,0,4000,1,{STEP},-1e-6,0,1e-4,0.5,0"
        if command == ":WAV:DATA?":
            codes = [round((self.volts(k * STEP - 1e-6) - 0.5) / 1e-4) + (-1) ** k * 300 for k in range(4000)]
            data = b"".join(code.to_bytes(2, "big", signed=True) for code in codes)
            return f"#8{len(data):08}".encode() + data + b"\n"
        return super().answer(command)

    @staticmethod
    def volts(time):
        closed = [state for edge, state in EDGES if edge <= time]
        return 0.0 if closed and closed[-1] else 1.0


class ScpiDevice(unittest.TestCase):
    def setUp(self):
        self.generator, self.oscilloscope = Instrument(), Oscilloscope()

    def tearDown(self):
        for server in (self.generator, self.oscilloscope):
            server.shutdown()
            server.server_close()

    def answers(self, *shots, options=("--amplifier", "20")):
        told = "".join(json.dumps(shot) + "\n" for shot in [*shots, {"done": True}])
        done = subprocess.run([sys.executable, str(ROOT / "examples/scpi_device.py"), "--generator", self.generator.address(), "--oscilloscope",
                               self.oscilloscope.address(), "--sample-rate", str(SAMPLE_RATE), *options],
                              input=told, capture_output=True, text=True, timeout=30, check=True)
        return [json.loads(line) for line in done.stdout.splitlines()]

    @staticmethod
    def shot(number=1, drive="main"):
        return {"shot": number, "hold_s": 30e-6, "drives": {drive: {"time_s": [0, 0, 10e-6, 12e-6], "V": [0, 18, 18, 4]}}}

    def test_the_edges_of_the_record_are_found(self):
        for number, answer in enumerate(self.answers(self.shot(1), self.shot(2)), 1):
            self.assertEqual(answer["shot"], number)
            self.assertEqual([state for _, state in answer["edges_s"]], [1, 0, 1])
            for found, (time, _) in zip(answer["edges_s"], EDGES):
                self.assertLessEqual(abs(found[0] - time), STEP)

    def test_the_generator_is_told_the_volts_over_the_amplification(self):
        self.answers(self.shot())
        high = float(re.search(r"SOUR1:VOLT:HIGH ([^;]+)", "\n".join(self.generator.commands))[1])
        self.assertAlmostEqual(high, 18 / 20)
        data = self.generator.data
        volts = [20 * high / 32767 * int.from_bytes(data[i : i + 2], "big", signed=True) for i in range(0, len(data), 2)]
        self.assertEqual(len(volts), 421)  # 42 us at 10 MHz, and the last one, which is held
        for time, due in ((0, 18), (5e-6, 18), (10e-6, 18), (11e-6, 11), (12e-6, 4), (42e-6, 4)):
            self.assertAlmostEqual(volts[round(time * SAMPLE_RATE)], due, places=3)
        self.assertIn("*TRG", self.generator.commands)
        self.assertIn(":SING", self.oscilloscope.commands)

    def test_the_amplifier_of_the_scene_is_counted_once(self):
        told = self.shot()
        told["drives"]["main"]["amplifier"] = 20
        for options, factor in (((), 20), (("--amplifier", "10"), 10)):
            self.answers(told, options=options)
            self.assertAlmostEqual(float(re.findall(r"SOUR1:VOLT:HIGH ([^;]+)", "\n".join(self.generator.commands))[-1]), 18 / factor)

    def test_what_an_instrument_complains_of_is_the_answer(self):
        self.generator.error = '-222,"Data out of range"'
        self.assertEqual(self.answers(self.shot()), [{"shot": 1, "error": '-222,"Data out of range"'}])

    def test_a_drive_that_no_generator_gives_is_refused(self):
        self.assertIn("gives main alone", self.answers(self.shot(drive="piezo"))[0]["error"])


if __name__ == "__main__":
    unittest.main()
