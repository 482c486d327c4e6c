/* Everything the writer counts, in the order of the counters in the segment. Plain C, like segment_layout.h.
 * New counters are added at the end; a reader shows the names it finds in the segment.
 */
#ifndef LINESCOPE_IPC_SEGMENT_COUNTERS_H
#define LINESCOPE_IPC_SEGMENT_COUNTERS_H

/* clang-format off */
#define LS_COUNTERS(X) \
  /* camera */ \
  X(frames_received) \
  X(frames_unreadable)              /* picture could not be decoded */ \
  X(frames_wrong_size)              /* not the size of the calibration */ \
  X(frames_lost)                    /* numbered by the camera, never arrived */ \
  X(frames_overrun)                 /* arrived while the one before was still in work */ \
  X(frames_out_of_order) \
  X(camera_reconnects) \
  /* pictures that gave no line, by reason */ \
  X(frames_not_scanning) \
  X(frames_line_not_found) \
  X(frames_line_too_short) \
  X(frames_no_pose_before) \
  X(frames_no_pose_after) \
  X(frames_pose_gap_too_long) \
  X(frames_pose_distorted) \
  X(frames_pose_out_of_view) \
  X(frames_pose_stale) \
  X(frames_pose_missing) \
  X(frames_pose_disconnected) \
  X(frames_pose_never_seen) \
  X(frames_no_surface_point)        /* line found, but no point of it survived */ \
  /* lines and points */ \
  X(lines_offered) \
  X(lines_published) \
  X(lines_not_scanning) \
  X(lines_segment_full) \
  X(lines_invalid)                  /* no point, or more points than a line may have */ \
  X(lines_undone) \
  X(points_published) \
  X(points_segment_full) \
  X(points_too_weak) \
  X(points_too_wide) \
  X(points_saturated) \
  X(points_low_snr) \
  X(points_ambiguous)               /* a second candidate as good as the first */ \
  X(points_outside_picture) \
  X(points_no_intersection)         /* ray runs along the laser plane or meets it behind the camera */ \
  X(points_too_near) \
  X(points_too_far) \
  X(points_isolated) \
  X(points_not_finite) \
  X(scans_started) \
  /* pictures for the viewers */ \
  X(pictures_published) \
  X(pictures_too_large) \
  X(picture_samples_dropped)        /* more line samples than the record holds */ \
  /* tracker */ \
  X(tracker_samples_received) \
  X(tracker_samples_published) \
  X(tracker_samples_lost) \
  X(tracker_samples_unreadable) \
  X(tracker_samples_out_of_order) \
  X(tracker_samples_not_finite) \
  X(tracker_samples_unknown_station) \
  X(tracker_samples_distorted) \
  X(tracker_samples_out_of_view) \
  X(tracker_reconnects) \
  /* commands */ \
  X(commands_received) \
  X(commands_done) \
  X(commands_refused) \
  X(commands_unknown) \
  X(commands_damaged) \
  X(commands_sender_died) \
  X(answers_not_collected) \
  /* ourselves */ \
  X(texts_too_long) \
  X(heartbeats_late)                /* more than 50 ms after the one before */ \
  X(recording_dropped)              /* the recorder could not keep up */ \
  X(frames_late)                    /* older than the camera's period when they were taken */

enum ls_counter_id {
#define LS_COUNTER_ID(name) LS_COUNT_##name,
  LS_COUNTERS(LS_COUNTER_ID)
#undef LS_COUNTER_ID
  LS_COUNTER_COUNT
};

/* Stages of the way of a picture and of a pose whose duration is kept. */
#define LS_LATENCIES(X) \
  X(frame_wait)       /* exposure's middle until the picture arrived */ \
  X(extract)          /* line extraction */ \
  X(pose_wait)        /* until the poses on both sides of the picture were there */ \
  X(reconstruct)      /* line to points in world */ \
  X(publish_line) \
  X(publish_picture) \
  X(frame_total)      /* exposure's middle until the line was in the segment */ \
  X(pose_total)       /* acquisition of a pose until it was in the segment */ \
  X(publish_pose) \
  X(command)          /* sent until answered */ \
  X(tracker_clock)    /* typical distance of an arrival from the fit of the tracker's clock */

enum ls_latency_id {
#define LS_LATENCY_ID(name) LS_LATENCY_##name,
  LS_LATENCIES(LS_LATENCY_ID)
#undef LS_LATENCY_ID
  LS_LATENCY_COUNT
};
/* clang-format on */

#endif /* LINESCOPE_IPC_SEGMENT_COUNTERS_H */
