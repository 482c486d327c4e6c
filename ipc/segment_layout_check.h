/* Every offset and size of segment_layout.h, asserted while compiling. Included by it; nothing to use here.
 */
#ifndef LINESCOPE_IPC_SEGMENT_LAYOUT_CHECK_H
#define LINESCOPE_IPC_SEGMENT_LAYOUT_CHECK_H

/* clang-format off */
#ifdef __cplusplus
#define LS_STATIC_ASSERT(condition, text) static_assert(condition, text)
#else
#define LS_STATIC_ASSERT(condition, text) _Static_assert(condition, text)
#endif
#define LS_ASSERT_AT(type, member, offset) \
  LS_STATIC_ASSERT(offsetof(struct type, member) == (offset), #type "." #member " moved")
#define LS_ASSERT_SIZE(type, size) LS_STATIC_ASSERT(sizeof(struct type) == (size), #type " changed its size")

LS_ASSERT_AT(ls_section, kind, 0);
LS_ASSERT_AT(ls_section, record_bytes, 4);
LS_ASSERT_AT(ls_section, offset, 8);
LS_ASSERT_AT(ls_section, bytes, 16);
LS_ASSERT_AT(ls_section, record_count, 24);
LS_ASSERT_AT(ls_section, ring_count, 28);
LS_ASSERT_AT(ls_section, ring_bytes, 32);
LS_ASSERT_SIZE(ls_section, 48);

LS_ASSERT_AT(ls_header, magic, 0);
LS_ASSERT_AT(ls_header, layout_major, 8);
LS_ASSERT_AT(ls_header, layout_minor, 12);
LS_ASSERT_AT(ls_header, endian_mark, 16);
LS_ASSERT_AT(ls_header, header_bytes, 20);
LS_ASSERT_AT(ls_header, total_bytes, 24);
LS_ASSERT_AT(ls_header, session_id, 32);
LS_ASSERT_AT(ls_header, started_ns, 40);
LS_ASSERT_AT(ls_header, started_utc_ns, 48);
LS_ASSERT_AT(ls_header, writer_start_ticks, 56);
LS_ASSERT_AT(ls_header, pid_namespace, 64);
LS_ASSERT_AT(ls_header, writer_pid, 72);
LS_ASSERT_AT(ls_header, writer_uid, 76);
LS_ASSERT_AT(ls_header, section_count, 80);
LS_ASSERT_AT(ls_header, counter_count, 84);
LS_ASSERT_AT(ls_header, latency_count, 88);
LS_ASSERT_AT(ls_header, picture_samples, 92);
LS_ASSERT_AT(ls_header, program, 96);
LS_ASSERT_AT(ls_header, control_name, 144);
LS_ASSERT_AT(ls_header, sections, 512);
LS_ASSERT_AT(ls_header, heartbeat_count, 2048);
LS_ASSERT_AT(ls_header, heartbeat_ns, 2056);
LS_ASSERT_AT(ls_header, closed, 2064);
LS_ASSERT_AT(ls_header, news, 2112);
LS_ASSERT_AT(ls_header, published, 2176);
LS_ASSERT_AT(ls_header, next_serial, 2184);
LS_ASSERT_AT(ls_header, points_used, 2192);
LS_ASSERT_AT(ls_header, scanning, 2200);
LS_ASSERT_AT(ls_header, full, 2204);
LS_ASSERT_AT(ls_header, replaced_by, 2240);
LS_ASSERT_SIZE(ls_header, 4096);

LS_ASSERT_AT(ls_ring, head, 0);
LS_ASSERT_SIZE(ls_ring, 64);

LS_ASSERT_AT(ls_state_record, index, 0);
LS_ASSERT_AT(ls_state_record, since_ns, 8);
LS_ASSERT_AT(ls_state_record, state, 16);
LS_ASSERT_AT(ls_state_record, reason, 24);
LS_ASSERT_SIZE(ls_state_record, 256);

LS_ASSERT_AT(ls_sensor_record, index, 0);
LS_ASSERT_AT(ls_sensor_record, time_ns, 8);
LS_ASSERT_AT(ls_sensor_record, last_good_ns, 16);
LS_ASSERT_AT(ls_sensor_record, samples, 24);
LS_ASSERT_AT(ls_sensor_record, lost, 32);
LS_ASSERT_AT(ls_sensor_record, role, 40);
LS_ASSERT_AT(ls_sensor_record, state, 44);
LS_ASSERT_AT(ls_sensor_record, nominal_hz, 48);
LS_ASSERT_AT(ls_sensor_record, name, 56);
LS_ASSERT_AT(ls_sensor_record, reason, 88);
LS_ASSERT_SIZE(ls_sensor_record, 256);

LS_ASSERT_AT(ls_camera_record, index, 0);
LS_ASSERT_AT(ls_camera_record, time_ns, 8);
LS_ASSERT_AT(ls_camera_record, last_good_ns, 16);
LS_ASSERT_AT(ls_camera_record, frames, 24);
LS_ASSERT_AT(ls_camera_record, state, 32);
LS_ASSERT_AT(ls_camera_record, width, 36);
LS_ASSERT_AT(ls_camera_record, height, 40);
LS_ASSERT_AT(ls_camera_record, nominal_hz, 44);
LS_ASSERT_AT(ls_camera_record, exposure_ms, 48);
LS_ASSERT_AT(ls_camera_record, name, 56);
LS_ASSERT_AT(ls_camera_record, reason, 120);
LS_ASSERT_SIZE(ls_camera_record, 256);

LS_ASSERT_AT(ls_text_record, index, 0);
LS_ASSERT_AT(ls_text_record, time_ns, 8);
LS_ASSERT_AT(ls_text_record, text_bytes, 16);
LS_ASSERT_SIZE(ls_text_record, 32);

LS_ASSERT_AT(ls_pose_record, index, 0);
LS_ASSERT_AT(ls_pose_record, time_ns, 8);
LS_ASSERT_AT(ls_pose_record, position, 16);
LS_ASSERT_AT(ls_pose_record, quaternion, 40);
LS_ASSERT_AT(ls_pose_record, frame_count, 72);
LS_ASSERT_AT(ls_pose_record, distortion, 76);
LS_ASSERT_AT(ls_pose_record, station, 80);
LS_ASSERT_AT(ls_pose_record, state, 84);
LS_ASSERT_SIZE(ls_pose_record, 96);

LS_ASSERT_AT(ls_scan_record, index, 0);
LS_ASSERT_AT(ls_scan_record, started_ns, 8);
LS_ASSERT_AT(ls_scan_record, first_serial, 16);
LS_ASSERT_AT(ls_scan_record, generation, 24);
LS_ASSERT_AT(ls_scan_record, scan_id, 28);
LS_ASSERT_AT(ls_scan_record, kept_lines, 32);
LS_ASSERT_AT(ls_scan_record, cause, 36);
LS_ASSERT_SIZE(ls_scan_record, 64);

LS_ASSERT_AT(ls_line_pose, position, 0);
LS_ASSERT_AT(ls_line_pose, quaternion, 24);
LS_ASSERT_AT(ls_line_pose, state, 56);
LS_ASSERT_SIZE(ls_line_pose, 64);

LS_ASSERT_AT(ls_line_record, serial, 0);
LS_ASSERT_AT(ls_line_record, time_ns, 8);
LS_ASSERT_AT(ls_line_record, frame, 16);
LS_ASSERT_AT(ls_line_record, first_point, 24);
LS_ASSERT_AT(ls_line_record, point_count, 32);
LS_ASSERT_AT(ls_line_record, scan_id, 36);
LS_ASSERT_AT(ls_line_record, index, 40);
LS_ASSERT_AT(ls_line_record, poses, 48);
LS_ASSERT_AT(ls_line_record, mean_peak, 240);
LS_ASSERT_AT(ls_line_record, mean_width, 244);
LS_ASSERT_AT(ls_line_record, mean_snr, 248);
LS_ASSERT_AT(ls_line_record, mean_deviation, 252);
LS_ASSERT_AT(ls_line_record, coverage, 256);
LS_ASSERT_AT(ls_line_record, rejected, 260);
LS_ASSERT_AT(ls_line_record, pose_gap_ns, 264);
LS_ASSERT_AT(ls_line_record, checksum, 312);
LS_ASSERT_SIZE(ls_line_record, 320);

LS_ASSERT_AT(ls_point, position, 0);
LS_ASSERT_AT(ls_point, intensity, 12);
LS_ASSERT_AT(ls_point, standard_deviation, 16);
LS_ASSERT_SIZE(ls_point, 20);

LS_ASSERT_AT(ls_picture_record, index, 0);
LS_ASSERT_AT(ls_picture_record, time_ns, 8);
LS_ASSERT_AT(ls_picture_record, frame, 16);
LS_ASSERT_AT(ls_picture_record, width, 24);
LS_ASSERT_AT(ls_picture_record, height, 28);
LS_ASSERT_AT(ls_picture_record, stride, 32);
LS_ASSERT_AT(ls_picture_record, format, 36);
LS_ASSERT_AT(ls_picture_record, sample_count, 40);
LS_ASSERT_AT(ls_picture_record, name, 48);
LS_ASSERT_SIZE(ls_picture_record, 120);

LS_ASSERT_AT(ls_line_sample, u, 0);
LS_ASSERT_AT(ls_line_sample, v, 4);
LS_ASSERT_AT(ls_line_sample, peak, 8);
LS_ASSERT_AT(ls_line_sample, snr, 12);
LS_ASSERT_SIZE(ls_line_sample, 16);

LS_ASSERT_AT(ls_frame_record, index, 0);
LS_ASSERT_AT(ls_frame_record, time_ns, 8);
LS_ASSERT_AT(ls_frame_record, frame, 16);
LS_ASSERT_AT(ls_frame_record, published_ns, 24);
LS_ASSERT_SIZE(ls_frame_record, 32);

LS_ASSERT_AT(ls_counter, name, 0);
LS_ASSERT_AT(ls_counter, value, 48);
LS_ASSERT_SIZE(ls_counter, 64);

LS_ASSERT_AT(ls_latency, name, 0);
LS_ASSERT_AT(ls_latency, count, 32);
LS_ASSERT_AT(ls_latency, sum_ns, 40);
LS_ASSERT_AT(ls_latency, max_ns, 48);
LS_ASSERT_AT(ls_latency, last_ns, 56);
LS_ASSERT_AT(ls_latency, buckets, 64);
LS_ASSERT_SIZE(ls_latency, 1088);

#undef LS_ASSERT_AT
#undef LS_ASSERT_SIZE
/* clang-format on */

#endif /* LINESCOPE_IPC_SEGMENT_LAYOUT_CHECK_H */
