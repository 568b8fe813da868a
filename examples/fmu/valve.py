"""A valve in its system: battery, step-up converter, bender, valve. FMPy is the master.

    impactcheck fmu scenes/examples/rocker-flight.toml --modes 24 -o valve.fmu
    python3 examples/fmu/valve.py valve.fmu [--figure valve.svg]

A battery charges the bender by a step-up converter. At the wanted voltage the bender is released.
It strikes the membrane, which throws the sphere. The unit computes the impact and where the sphere
goes. The master takes steps of 50 us. Which voltage shifts the valve?
"""

import argparse
import shutil
import sys

from fmpy import extract, read_model_description
from fmpy.fmi3 import FMU3Slave

STEP = 50e-6
END = 16e-3
NOMINAL = 150.0
"""Voltage in V at which the bender strikes at the speed in the scene; both are proportional."""


class Supply:
    """Battery and step-up converter, which charge the capacitance of the bender."""

    battery = 3.0  # V without load
    resistance = 2.0  # Ohm inside the battery
    inductance = 100e-6  # H
    peak_current = 0.1  # A at which the switch opens
    share = 0.8  # of the coil's energy that reaches the bender
    capacitance = 50e-9  # F of the bender

    def __init__(self):
        self.energy = 0.0

    @property
    def voltage(self):
        """Of the bender, V."""
        return (2.0 * self.energy / self.capacitance) ** 0.5

    def step(self, length):
        """Cycles of the coil: its current rises to the peak, then its energy goes to the bender."""
        source = self.battery - 0.5 * self.resistance * self.peak_current
        rise = self.inductance * self.peak_current / source
        fall = self.inductance * self.peak_current / max(self.voltage, source)
        cycle = 0.5 * self.inductance * self.peak_current**2
        self.energy += self.share * cycle * length / (rise + fall)


def log(_environment, _status, _category, message):
    """A line of the unit's log."""
    print(message.decode(), file=sys.stderr)


class Valve:
    """The unit, its variables by name."""

    def __init__(self, file):
        described = read_model_description(file)
        self.folder = extract(file)
        self.variables = {variable.name: variable for variable in described.modelVariables}
        self.unit = FMU3Slave(
            guid=described.guid,
            unzipDirectory=self.folder,
            modelIdentifier=described.coSimulation.modelIdentifier,
            instanceName="valve",
        )
        self.unit.instantiate(logMessage=log)
        self.begin()

    def begin(self):
        """To the first communication point."""
        self.unit.enterInitializationMode(startTime=0.0)
        self.unit.exitInitializationMode()

    def get(self, name):
        """Value of a variable."""
        variable = self.variables[name]
        return getattr(self.unit, "get" + variable.type)([variable.valueReference])[0]

    def set(self, name, value):
        """Set an input or a parameter."""
        variable = self.variables[name]
        getattr(self.unit, "set" + variable.type)([variable.valueReference], [value])

    def close(self):
        """End the unit."""
        self.unit.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)


def simulate(valve, wanted):
    """The system until the end, released at the voltage ``wanted``; its course."""
    supply, course, released = Supply(), [], None
    speed = float(valve.variables["outer.speed"].start)
    for number in range(round(END / STEP)):
        time = number * STEP
        if released is None:
            supply.step(STEP)
            if supply.voltage >= wanted:
                released = time
                valve.set("outer.speed", speed * supply.voltage / NOMINAL)
                valve.set("launch", True)
        valve.unit.doStep(time, STEP)
        velocities = [valve.get("outer_velocity"), valve.get("inner_velocity")]
        course.append((time + STEP, supply.voltage, *velocities))
    return released, course


def draw(file, course):
    """Voltage and velocities over time."""
    import matplotlib.pyplot as plt

    time, voltage, bender, sphere = zip(*course, strict=True)
    figure, (above, below) = plt.subplots(2, sharex=True, figsize=(7, 5))
    milliseconds = [1e3 * t for t in time]
    above.plot(milliseconds, voltage)
    above.set_ylabel("bender, V")
    below.plot(milliseconds, bender, label="bender's tip")
    below.plot(milliseconds, sphere, label="sphere")
    below.set_xlabel("time, ms")
    below.set_ylabel("velocity, m/s")
    below.legend()
    figure.tight_layout()
    figure.savefig(file)


def main():
    """Search the voltage that shifts."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("unit", help="valve.fmu")
    parser.add_argument("--figure", help="figure of the last run (needs matplotlib)")
    arguments = parser.parse_args()
    valve = Valve(arguments.unit)
    print("voltage  released  sphere's speed  shifts  valid")
    for wanted in (120.0, 150.0, 180.0, 210.0, 240.0):
        released, course = simulate(valve, wanted)
        shifts = "yes" if valve.get("shifts") else "no"
        speed = abs(valve.get("inner_velocity_final"))
        valid = "yes" if valve.get("valid") else "no"
        when = f"{1e3 * released:6.2f} ms"
        print(f"{wanted:5.0f} V {when} {1e3 * speed:9.0f} mm/s    {shifts:6}  {valid}")
        valve.unit.reset()
        valve.begin()
    valve.close()
    if arguments.figure:
        draw(arguments.figure, course)


if __name__ == "__main__":
    main()
