#!/usr/bin/env python3
"""Checks tools/attach.py: its layout against docs/segment.md, its reading against the test publisher.

    check_attach.py FOLDER_OF_ATTACH SEGMENT docs/segment.md
"""
import sys
import time

import numpy as np

from independent_reader import need, structures


def same_layout(attach, document):
    documented = structures(document)
    for name, own in {"ls_header": attach.HEADER, "ls_section": attach.SECTION, "ls_state_record": attach.STATE,
                      "ls_sensor_record": attach.SENSOR, "ls_pose_record": attach.POSE, "ls_scan_record": attach.SCAN,
                      "ls_line_pose": attach.LINE_POSE, "ls_line_record": attach.LINE, "ls_point": attach.POINT,
                      "ls_picture_record": attach.PICTURE, "ls_counter": attach.COUNTER}.items():
        need(own.itemsize == documented[name].itemsize, f"{name}: size")
        for member in own.names:
            need(own.fields[member][1] == documented[name].fields[member][1], f"{name}.{member}: offset")
            need(own.fields[member][0].itemsize == documented[name].fields[member][0].itemsize, f"{name}.{member}: type")


def lines_are_complete(segment):
    """Every serial delivered or counted as missed, every line as it was made up."""
    expected = checked = 0
    end = time.monotonic() + 1.5
    while time.monotonic() < end or checked < 100:
        lines, points = segment.new_lines()
        fresh = [int(s) for s in lines["serial"] if s >= expected]
        expected += segment.missed + len(fresh)
        need(not fresh or fresh[-1] + 1 == expected, "a line is neither delivered nor counted as missed")
        for line in lines:
            serial, count, first = int(line["serial"]), int(line["point_count"]), int(line["first_point"])
            own = points[first:first + count]["position"]
            s = np.float32(serial % 65536)
            i = np.arange(count, dtype=np.float32)
            need((own == np.stack([np.full(count, s), i, s - i], 1)).all(), f"line {serial}")
            checked += 1
    return checked


def main(folder, name, document):
    sys.path.insert(0, folder)
    import attach
    same_layout(attach, document)
    segment = attach.Segment(name)
    for _ in range(1000):  # a starved writer is silent for a moment
        if segment.life() == "live":
            break
        time.sleep(0.01)
    need(segment.life() == "live", "life")
    checked = lines_are_complete(segment)
    picture = segment.picture()
    need(picture.shape == (120, 160, 3) and (picture == picture[0, 0, 0]).all(), "picture")
    need(segment.samples.shape == (1, 4) and segment.samples[0, 0] == 1.5, "line in the picture")
    need(segment.state() == ("scanning", "made-up lines"), "state")
    need(segment.sensor(0)[:2] == ("endoscope", "ok") and segment.sensor(5) is None, "sensors")
    need(segment.pose(3)["position"][1] == 3, "pose")
    need(segment.counters()["lines_published"] >= checked > 0, "counters")
    need(not np.isnan(segment.points()["position"]).any(), "filling points among the points")
    try:
        attach.Segment(name + "-control")
        need(False, "the control segment was taken for a segment")
    except attach.Refused as reason:
        need("no linescope segment" in str(reason), "reason of the refusal")
    print(f"{checked} lines checked")


if __name__ == "__main__":
    main(*sys.argv[1:4])
