#!/usr/bin/env python3
"""Reads a linescope segment from Python: the example for people who write viewers, recorders, evaluations of their own.

    tools/attach.py                  follow segment "linescope" and print what comes, until Ctrl-C
    tools/attach.py --once           one look
    tools/attach.py --save scan.csv  the points of the scan so far (x, y, z, intensity, sd; mm, world)

As a module:

    import attach
    segment = attach.Segment("linescope")       # raises attach.Refused with a sentence when it cannot
    pose = segment.pose(0)                      # newest pose of station 0, or None
    lines, points = segment.new_lines()         # numpy arrays of what came since the last call
    image = segment.picture()                   # height x width (x 3) array, or None when there is no new one

Only the standard library and numpy. The layout and the two rules by which reading is consistent are those of docs/segment.md.
The mapping is read-only: nothing done here disturbs the daemon.
"""
import argparse
import mmap
import os
import sys
import time

import numpy as np


def _layout(size, *members):
    names, formats, offsets = zip(*members)
    return np.dtype({"names": names, "formats": formats, "offsets": offsets, "itemsize": size})


SECTION = _layout(48, ("kind", "u4", 0), ("record_bytes", "u4", 4), ("offset", "u8", 8), ("bytes", "u8", 16),
                  ("record_count", "u4", 24), ("ring_count", "u4", 28), ("ring_bytes", "u8", 32))
HEADER = _layout(4096, ("magic", "u8", 0), ("layout_major", "u4", 8), ("layout_minor", "u4", 12), ("endian_mark", "u4", 16),
                 ("total_bytes", "u8", 24), ("session_id", "u8", 32), ("started_ns", "i8", 40), ("writer_pid", "u4", 72),
                 ("section_count", "u4", 80), ("counter_count", "u4", 84), ("picture_samples", "u4", 92),
                 ("program", "S48", 96), ("sections", (SECTION, (24,)), 512), ("heartbeat_count", "u8", 2048),
                 ("heartbeat_ns", "i8", 2056), ("closed", "u4", 2064), ("published", "u8", 2176), ("scanning", "u4", 2200),
                 ("full", "u4", 2204), ("replaced_by", "u8", 2240))
STATE = _layout(256, ("index", "u8", 0), ("since_ns", "i8", 8), ("state", "u4", 16), ("reason", "S232", 24))
SENSOR = _layout(256, ("index", "u8", 0), ("time_ns", "i8", 8), ("samples", "u8", 24), ("lost", "u8", 32), ("role", "u4", 40),
                 ("state", "u4", 44), ("name", "S32", 56), ("reason", "S168", 88))
POSE = _layout(96, ("index", "u8", 0), ("time_ns", "i8", 8), ("position", ("f8", (3,)), 16), ("quaternion", ("f8", (4,)), 40),
               ("frame_count", "u4", 72), ("distortion", "f4", 76), ("station", "u4", 80), ("state", "u4", 84))
SCAN = _layout(64, ("index", "u8", 0), ("started_ns", "i8", 8), ("first_serial", "u8", 16), ("generation", "u4", 24),
               ("scan_id", "u4", 28), ("kept_lines", "u4", 32), ("cause", "u4", 36))
LINE_POSE = _layout(64, ("position", ("f8", (3,)), 0), ("quaternion", ("f8", (4,)), 24), ("state", "u4", 56))
LINE = _layout(320, ("serial", "u8", 0), ("time_ns", "i8", 8), ("frame", "u8", 16), ("first_point", "u8", 24),
               ("point_count", "u4", 32), ("scan_id", "u4", 36), ("index", "u4", 40), ("poses", (LINE_POSE, (3,)), 48),
               ("mean_peak", "f4", 240), ("mean_width", "f4", 244), ("mean_snr", "f4", 248), ("mean_deviation", "f4", 252),
               ("coverage", "f4", 256), ("rejected", "u4", 260), ("pose_gap_ns", "i8", 264), ("checksum", "u8", 312))
POINT = _layout(20, ("position", ("f4", (3,)), 0), ("intensity", "f4", 12), ("standard_deviation", "f4", 16))
PICTURE = _layout(120, ("index", "u8", 0), ("time_ns", "i8", 8), ("frame", "u8", 16), ("width", "u4", 24), ("height", "u4", 28),
                  ("stride", "u4", 32), ("format", "u4", 36), ("sample_count", "u4", 40), ("name", "S64", 48))
COUNTER = _layout(64, ("name", "S48", 0), ("value", "u8", 48))

# Kinds of section that this script uses, with the structure at the start of their records.
RECORDS = {1: STATE, 2: SENSOR, 5: POSE, 6: SCAN, 7: LINE, 8: POINT, 9: PICTURE, 11: COUNTER}
STATES = ["starting", "idle", "scanning", "full", "camera lost", "tracker lost", "stopping"]
TOOL_STATES = ["ok", "distorted field", "out of view", "stale", "missing", "disconnected", "never seen"]
ROLES = ["none", "endoscope", "object", "harvester", "other"]


class Refused(Exception):
    """Why the segment cannot be read, in one sentence."""


def word(words, number):
    return words[number] if number < len(words) else "unknown"


class Segment:
    def __init__(self, name="linescope"):
        self.name, self._generation, self._next_line, self._next_serial, self._pictures = name, 0, 0, 0, 0
        try:
            descriptor = os.open("/dev/shm/" + name, os.O_RDONLY)
        except FileNotFoundError:
            raise Refused(f"there is no segment {name}: no linescope daemon of that name is running") from None
        except PermissionError:
            raise Refused(f"segment {name} belongs to another user") from None
        try:
            self._file = os.fstat(descriptor)
            if self._file.st_size < HEADER.itemsize:
                raise Refused(f"segment {name} is just being set up, or truncated")
            self._map = mmap.mmap(descriptor, self._file.st_size, prot=mmap.PROT_READ)
        finally:
            os.close(descriptor)
        self._bytes = np.frombuffer(self._map, np.uint8)
        self.header = self._bytes[:HEADER.itemsize].view(HEADER)[0]
        self._check()

    def _check(self):
        """Nothing in the segment is trusted before it was compared with the mapping."""
        h = self.header
        if h["magic"].tobytes() != b"LINESCOP":
            raise Refused(f"/dev/shm/{self.name} is no linescope segment, or just being set up")
        if h["endian_mark"] != 0x01020304 or h["layout_major"] != 1:
            raise Refused(f"segment {self.name} has another byte order or layout version {h['layout_major']}")
        if h["total_bytes"] != self._file.st_size or h["section_count"] > 24:
            raise Refused(f"segment {self.name} is truncated or damaged")
        self._sections = {}
        for s in h["sections"][:h["section_count"]]:
            s = {key: int(s[key]) for key in SECTION.names}
            if s["kind"] not in RECORDS:
                continue
            rings, body = max(1, s["ring_count"]), s["record_count"] * s["record_bytes"]
            ring = s["ring_bytes"] if s["ring_count"] else s["bytes"]
            head = 64 if s["ring_count"] else 0
            if (s["offset"] + s["bytes"] > self._file.st_size or head + body > ring or rings * ring > s["bytes"]
                    or s["record_bytes"] < RECORDS[s["kind"]].itemsize or s["record_count"] < 1):
                raise Refused(f"segment {self.name} is damaged (section {s['kind']})")
            self._sections[s["kind"]] = s
        if set(RECORDS) - set(self._sections):
            raise Refused(f"segment {self.name} is damaged (a section is missing)")

    def life(self):
        """"live", or what became of the daemon."""
        try:
            now = os.stat("/dev/shm/" + self.name)
        except FileNotFoundError:
            now = None
        if self.header["replaced_by"] or (now and (now.st_dev, now.st_ino) != (self._file.st_dev, self._file.st_ino)):
            return "replaced"
        if self.header["closed"]:
            return "closed"
        if now is None:
            return "removed"
        return "live" if abs(time.monotonic_ns() - int(self.header["heartbeat_ns"])) < 150_000_000 else "silent"

    def _newest(self, kind, ring=0):
        """The ring rule: (record, bytes of its slot), or None when nothing was published or the writer was faster."""
        s = self._sections[kind]
        start = s["offset"] + s["ring_bytes"] * ring
        head = self._bytes[start:start + 8].view(np.uint64)
        for _ in range(20):
            index = int(head[0]) - 1
            if index < 0:
                return None
            place = start + 64 + s["record_bytes"] * (index % s["record_count"])
            slot = self._bytes[place:place + s["record_bytes"]].copy()
            if int(head[0]) - index < s["record_count"]:
                return slot[:RECORDS[kind].itemsize].view(RECORDS[kind])[0], slot
        return None

    def state(self):
        """(state, reason)"""
        found = self._newest(1)
        return (word(STATES, found[0]["state"]), found[0]["reason"].decode()) if found else ("unknown", "")

    def sensor(self, station):
        """(role, state, reason), or None."""
        found = self._newest(2, station)
        return found and (word(ROLES, found[0]["role"]), word(TOOL_STATES, found[0]["state"]), found[0]["reason"].decode())

    def pose(self, station):
        """Newest record of a station (0-based); its numbers mean something only when its state is 0 (ok)."""
        found = self._newest(5, station)
        return found and found[0]

    def counters(self):
        s = self._sections[11]
        rows = self._bytes[s["offset"]:s["offset"] + s["record_bytes"] * s["record_count"]].copy().view(COUNTER)
        return {row["name"].decode(): int(row["value"]) for row in rows[:self.header["counter_count"]]}

    def _copy_lines(self, first, count):
        s = self._sections[7]
        begin = s["offset"] + s["record_bytes"] * first
        rows = self._bytes[begin:begin + s["record_bytes"] * (count - first)].copy().reshape(-1, s["record_bytes"])
        return np.ascontiguousarray(rows[:, :LINE.itemsize]).view(LINE).reshape(-1)

    def new_lines(self):
        """(lines, points) published since the last call; lines["first_point"] counts in points.

        self.restarted tells that the scan was cleared, begun anew or shortened: forget what was made of the lines before.
        self.missed counts lines that can no longer be had.
        """
        self.restarted, self.missed = False, 0
        capacity = self._sections[8]["record_count"]
        for _ in range(20):
            published = int(self.header["published"])
            generation, count = published >> 32, published & 0xFFFFFFFF
            scan = self._newest(6)
            if generation == 0 or scan is None or count > self._sections[7]["record_count"]:
                break
            first = self._next_line if generation == self._generation else 0
            lines = self._copy_lines(first, count)
            begin = int(lines["first_point"][0]) if len(lines) else 0
            end = int((lines["first_point"] + lines["point_count"]).max()) if len(lines) else 0
            offset = self._sections[8]["offset"]
            points = self._bytes[offset + 20 * begin:offset + 20 * max(begin, min(end, capacity))].copy().view(POINT)
            # The scan rule: only when the generation is still the same, nothing of this was overwritten meanwhile.
            if int(self.header["published"]) >> 32 != generation or scan[0]["generation"] != generation:
                continue
            if end > capacity:
                raise Refused(f"segment {self.name} is damaged (a line without points)")
            self._account(generation, count, lines, scan[0])
            lines["first_point"] -= np.uint64(begin)
            return lines, points
        return np.zeros(0, LINE), np.zeros(0, POINT)

    def _account(self, generation, count, lines, scan):
        self.restarted = self._generation not in (0, generation)
        serials = [int(s) for s in lines["serial"]]
        known = self._next_serial
        last = max([known, int(scan["first_serial"])] + [s + 1 for s in serials])
        self.missed = last - known - sum(s >= known for s in serials)
        self._generation, self._next_line, self._next_serial = generation, count, last

    def picture(self):
        """The newest picture as an array, or None when there is no new one. self.samples: its line (u, v, peak, snr)."""
        found = self._newest(9)
        if found is None or found[0]["index"] + 1 == self._pictures:
            return None
        record, slot = found
        self._pictures = int(record["index"]) + 1
        width, height, stride = (int(record[key]) for key in ("width", "height", "stride"))
        channels = 3 if record["format"] == 2 else 1
        pixels = 120 + 16 * int(self.header["picture_samples"])
        if width * channels > stride or pixels + stride * height > len(slot):
            raise Refused(f"segment {self.name} is damaged (picture)")
        self.samples = slot[120:120 + 16 * int(record["sample_count"])].view(np.float32).reshape(-1, 4)
        rows = slot[pixels:pixels + stride * height].reshape(height, stride)[:, :width * channels]
        return rows.reshape(height, width, channels) if channels == 3 else rows

    def points(self):
        """All points of the scan so far, without the filling ones."""
        self._generation = 0
        _, points = self.new_lines()
        return points[~np.isnan(points["position"][:, 0])]


def describe(segment):
    state, reason = segment.state()
    lines, points = segment.new_lines()
    text = [f"{segment.life()}, {state}" + (f" ({reason})" if reason else "")]
    text.append(f"+{len(lines)} lines, +{len(points)} points" + (f", missed {segment.missed}" if segment.missed else ""))
    if segment.restarted:
        text.append("scan restarted")
    for station in range(8):
        pose = segment.pose(station)
        if pose is None:
            continue
        role = (segment.sensor(station) or ("station " + str(station + 1),))[0]
        place = "({:.1f}, {:.1f}, {:.1f}) mm".format(*pose["position"]) if pose["state"] == 0 else "--"
        text.append(f"{role} {word(TOOL_STATES, pose['state'])} {place}")
    return "; ".join(text)


def follow(name, once):
    segment = None
    while True:
        try:
            segment = segment or Segment(name)
            print(describe(segment), flush=True)
            if segment.life() in ("replaced", "closed", "removed"):
                segment = None  # attach to the successor, as soon as there is one
        except Refused as reason:
            segment = None
            print(reason, file=sys.stderr, flush=True)
            if once:
                return 1
        if once:
            return 0
        time.sleep(0.5)


def main():
    parser = argparse.ArgumentParser(description="Shows what a linescope segment holds.", epilog="Layout: docs/segment.md")
    parser.add_argument("segment", nargs="?", default="linescope")
    parser.add_argument("--once", action="store_true", help="one look, then end")
    parser.add_argument("--save", metavar="FILE", help="write the points of the scan so far as CSV")
    arguments = parser.parse_args()
    try:
        if arguments.save:
            points = Segment(arguments.segment).points()
            table = np.column_stack([points["position"], points["intensity"], points["standard_deviation"]])
            np.savetxt(arguments.save, table, "%.6g", ",", header="x_mm,y_mm,z_mm,intensity,sd_mm", comments="")
            print(f"{len(points)} points written to {arguments.save}")
            return 0
        return follow(arguments.segment, arguments.once)
    except Refused as reason:
        print(reason, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 0


if __name__ == "__main__":
    sys.exit(main())
