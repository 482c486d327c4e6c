#!/usr/bin/env python3
"""Reads the segment of the real daemon on its digital twin, knowing nothing but the tables of docs/segment.md.

    check_daemon.py SEGMENT docs/segment.md

Poses, lines, points, picture, status and texts; exits with 1 and a sentence when something is not as it must be.
"""
import sys
import time
import tomllib

import numpy as np

from independent_reader import Segment, counters, need, own_points, structures, text

OK = 0


def wait_for_lines(segment, count):
    end = time.monotonic() + 30
    while time.monotonic() < end:
        generation, records, points = segment.scan()
        if len(records) >= count:
            return records, points
        time.sleep(0.05)
    sys.exit(f"check_daemon: fewer than {count} lines in 30 s")


def check_lines(records, points, types):
    need((np.diff(records["serial"]) == 1).all() and (records["index"] == np.arange(len(records))).all(), "numbers of the lines")
    need((np.diff(records["time_ns"]) > 0).all(), "times of the lines")
    for record in records:
        own, filling = own_points(record, record.tobytes(), points, types)
        where = f"line {record['serial']}: "
        need(len(own) > 0 and np.isfinite(own["position"]).all(), where + "points")
        need(((own["intensity"] > 0) & (own["intensity"] <= 255)).all(), where + "intensities")
        need((own["standard_deviation"] > 0).all(), where + "standard deviations")
        need(np.isnan(filling["position"]).all(), where + "filling point")
        endoscope = record["poses"][0]
        need(endoscope["state"] == OK and abs(np.linalg.norm(endoscope["quaternion"]) - 1) < 1e-6, where + "pose of the endoscope")
        # An endoscope is some 20 cm long and sees some centimetres far.
        need((np.linalg.norm(own["position"] - endoscope["position"], axis=1) < 400).all(), where + "far from the endoscope")


def check_poses(segment):
    for station in range(3):
        record, _ = segment.newest(5, "ls_pose_record", station)
        need(record["station"] == station and record["state"] == OK, f"pose of station {station}: state {record['state']}")
        need(abs(np.linalg.norm(record["quaternion"]) - 1) < 1e-6, f"pose of station {station}: rotation")
        need(np.linalg.norm(record["position"]) > 1, f"pose of station {station}: position")
    need(all(segment.newest(5, "ls_pose_record", station) is None for station in range(3, 8)), "poses of stations that are not there")


def check_picture(segment):
    """The line in the picture lies where the picture is green."""
    record, slot = segment.newest(9, "ls_picture_record")
    width, height, stride = int(record["width"]), int(record["height"]), int(record["stride"])
    need(width > 0 and height > 0 and stride >= 3 * width and record["format"] == 2, "shape of the picture")
    begin = 120 + 16 * int(segment.header["picture_samples"])
    rows = slot[begin: begin + stride * height].reshape(height, stride)[:, :3 * width].reshape(height, width, 3).astype(int)
    samples = slot[120: 120 + 16 * int(record["sample_count"])].view(segment.types["ls_line_sample"])
    need(len(samples) > 10, "samples of the line in the picture")
    at = rows[np.rint(samples["v"]).astype(int), np.rint(samples["u"]).astype(int)]
    green = at[:, 1] > np.maximum(at[:, 0], at[:, 2])
    need(green.mean() > 0.9, f"only {green.mean():.0%} of the line's samples are green in the picture")


def check_status(segment, name):
    state, _ = segment.newest(1, "ls_state_record")
    need(state["state"] == 2, f"state {state['state']}, {state['reason']}")
    for station, role in enumerate([1, 2, 3]):
        sensor, _ = segment.newest(2, "ls_sensor_record", station)
        need(sensor["role"] == role and sensor["state"] == OK and sensor["nominal_hz"] == 240, f"status of station {station}")
        need(sensor["samples"] > 0 and sensor["lost"] == 0, f"samples of station {station}")
    camera, _ = segment.newest(3, "ls_camera_record")
    need(b"twin" in camera["name"] and camera["state"] == OK and abs(camera["nominal_hz"] - 30) < 0.01, "status of the camera")
    need(tomllib.loads(text(segment, 0))["run"]["segment"] == name, "configuration")
    need(text(segment, 1).startswith("%YAML"), "calibration")
    counted = counters(segment)
    need(counted["lines_published"] > 0 and counted["tracker_samples_published"] <= counted["tracker_samples_received"], "counters")


def main(name, document):
    segment = Segment(name, structures(document))
    beats = int(segment.header["heartbeat_count"])
    records, points = wait_for_lines(segment, 40)
    check_lines(records, points, segment.types)
    check_poses(segment)
    check_picture(segment)
    check_status(segment, name)
    need(int(segment.header["heartbeat_count"]) > beats, "the heart does not beat")
    print(f"{len(records)} lines checked")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
