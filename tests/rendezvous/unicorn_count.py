"""Count the instructions between the marks of a flight program with Unicorn, not QEMU's plugin.

    python unicorn_count.py replay.elf cortex-a9

It runs in the environment of the folder ``flight``, in the folder of the program's files, and
prints a number a solve. Unicorn has QEMU's translator of instructions, but neither its board nor
its loader, its semihosting or its plugins: what the program asks of a host is answered here (Arm's
semihosting, AArch32: the operation in r0, the place of its arguments in r1).
"""

import os
import struct
import sys
from pathlib import Path

from unicorn import UC_ARCH_ARM, UC_HOOK_CODE, UC_HOOK_INTR, UC_MODE_ARM, Uc, arm_const

# mov r10, r10 and mov r11, r11: the marks of flight/replay.c.
BEGIN, END = 0xE1A0A00A, 0xE1A0B00B
# Memory begins at a multiple of so many bytes below the program.
MEMORY_BYTES, ROOM_BYTES = 128 << 20, 1 << 24
LOADED = 1
# Operations of semihosting.
OPEN, CLOSE, WRITE, READ, TERMINAL, SEEK, LENGTH = 0x01, 0x02, 0x05, 0x06, 0x09, 0x0A, 0x0C
COMMAND, HEAP, EXIT, EXIT_WITH = 0x15, 0x16, 0x18, 0x20
FLAGS = {"r": os.O_RDONLY, "w": os.O_WRONLY | os.O_CREAT | os.O_TRUNC}
FAILED = 0xFFFFFFFF


class Host:
    """What semihosting asks of a host, with its files in the present folder."""

    def __init__(self, machine: Uc, base: int):
        self.machine, self.base = machine, base

    def words(self, at: int, count: int) -> tuple[int, ...]:
        """Words of memory."""
        return struct.unpack(f"<{count}I", self.machine.mem_read(at, 4 * count))

    def answer(self, operation: int, at: int) -> int | None:
        """What an operation returns; nothing where it ends the program."""
        if operation in (EXIT, EXIT_WITH):
            return None
        if operation == OPEN:
            name, mode, length = self.words(at, 3)
            path = bytes(self.machine.mem_read(name, length)).decode()
            # Modes are those of fopen in the order r, rb, r+, r+b, w, wb, ...
            if path.startswith(":"):
                # The terminal, and what semihosting has of extensions: none.
                return FAILED if path != ":tt" else int(mode >= 4)
            return os.open(path, FLAGS["r" if mode < 4 else "w"], 0o644)
        if operation == WRITE:
            handle, data, length = self.words(at, 3)
            return length - os.write(handle, bytes(self.machine.mem_read(data, length)))
        if operation == READ:
            handle, data, length = self.words(at, 3)
            found = os.read(handle, length)
            self.machine.mem_write(data, found)
            return length - len(found)
        if operation == CLOSE:
            (handle,) = self.words(at, 1)
            if handle > 2:
                os.close(handle)
            return 0
        if operation == SEEK:
            os.lseek(*self.words(at, 2), os.SEEK_SET)
            return 0
        if operation == LENGTH:
            return os.fstat(*self.words(at, 1)).st_size
        if operation == TERMINAL:
            return int(self.words(at, 1)[0] <= 2)
        if operation == HEAP:
            # Base and end of the heap, which grows up, and of the stack, which grows down.
            (block,) = self.words(at, 1)
            middle, end = self.base + MEMORY_BYTES // 2, self.base + MEMORY_BYTES
            self.machine.mem_write(block, struct.pack("<4I", middle, end, end, middle))
            return 0
        if operation == COMMAND:
            buffer, _ = self.words(at, 2)
            self.machine.mem_write(buffer, b"replay\0")
            self.machine.mem_write(at + 4, struct.pack("<I", len("replay")))
            return 0
        return FAILED


def load(machine: Uc, elf: bytes) -> None:
    """Put the segments of an ELF file in place."""
    (table,) = struct.unpack_from("<I", elf, 28)
    size, count = struct.unpack_from("<HH", elf, 42)
    for number in range(count):
        kind, offset, _, address, stored = struct.unpack_from("<5I", elf, table + number * size)
        if kind == LOADED:
            machine.mem_write(address, elf[offset : offset + stored])


def counts(elf: bytes, cpu: str) -> list[int]:
    """Instructions of each region between the marks."""
    machine = Uc(UC_ARCH_ARM, UC_MODE_ARM)
    machine.ctl_set_cpu_model(getattr(arm_const, "UC_CPU_ARM_" + cpu.upper().replace("-", "_")))
    (entry,) = struct.unpack_from("<I", elf, 24)
    base = entry & ~(ROOM_BYTES - 1)
    machine.mem_map(base, MEMORY_BYTES)
    load(machine, elf)
    host, found, running, counted = Host(machine, base), list[int](), False, 0
    words: dict[int, int] = {}

    def step(machine: Uc, address: int, size: int, _: object) -> None:
        nonlocal running, counted
        word = words.get(address)
        if word is None:
            word = words[address] = struct.unpack("<I", machine.mem_read(address, 4))[0]
        if word == BEGIN:
            running, counted = True, 0
        elif word == END:
            running = False
            found.append(counted)
        elif running:
            counted += 1

    def call(machine: Uc, number: int, _: object) -> None:
        answer = host.answer(
            machine.reg_read(arm_const.UC_ARM_REG_R0), machine.reg_read(arm_const.UC_ARM_REG_R1)
        )
        if answer is None:
            machine.emu_stop()
        else:
            machine.reg_write(arm_const.UC_ARM_REG_R0, answer)

    machine.hook_add(UC_HOOK_CODE, step)
    machine.hook_add(UC_HOOK_INTR, call)
    machine.emu_start(entry, 0)
    return found


if __name__ == "__main__":
    print(*counts(Path(sys.argv[1]).read_bytes(), sys.argv[2]))
