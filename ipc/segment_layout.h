/* The layout of the linescope segment, version 1.0: plain C (C11 and C++20), fixed width, no pointers.
 *
 * docs/segment.md holds the same as tables, with the rules for reading consistently; a test keeps both equal.
 * All numbers are in the byte order of the machine (see endian_mark).
 * Times: CLOCK_MONOTONIC, nanoseconds. Lengths: mm. Positions and rotations: `world`, the tracker's
 * transmitter; quaternions w x y z, world from tool. Texts: UTF-8, zero-terminated.
 *
 * Two rules cover everything that changes.
 *
 * Ring: record number i (0, 1, 2 ...) lies in slot i % record_count; `head` is the number of records ever
 * published. Copy record i, then read head again: the copy is good if and only if head - i < record_count.
 *
 * Scan: `published` is generation << 32 | lines. Lines 0 .. lines-1 and their points never change within a
 * generation. Copy, then read `published` again: the copy is good if and only if the generation is the same.
 *
 * Who writes: "life" is the heartbeat's thread, "state" the thread of set_state, "pose" the tracker's, "line"
 * the camera's, "any" are atomic additions by all threads of the writer. Readers map read-only.
 */
#ifndef LINESCOPE_IPC_SEGMENT_LAYOUT_H
#define LINESCOPE_IPC_SEGMENT_LAYOUT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LS_MAGIC UINT64_C(0x504f4353454e494c)          /* the bytes "LINESCOP" */
#define LS_MAGIC_CREATING UINT64_C(0x57454e53454e494c) /* "LINESNEW": being set up, not yet to be read */
#define LS_LAYOUT_MAJOR 1u                             /* another major version is not readable */
#define LS_LAYOUT_MINOR 0u                             /* a larger minor version only adds */
#define LS_ENDIAN_MARK 0x01020304u
#define LS_HEADER_BYTES 4096u
#define LS_MAX_SECTIONS 24u
#define LS_CACHE_LINE 64u

enum { LS_STATIONS = 8, LS_TOOLS = 3, LS_TEXTS = 2 };

/* Kinds of section. Every section is `ring_count` rings (ring header, then records) or, with ring_count 0, a
 * flat array. */
enum ls_section_kind {
  LS_SECTION_STATE = 1,     /* ring of ls_state_record; state */
  LS_SECTION_SENSORS = 2,   /* a ring of ls_sensor_record per station; pose */
  LS_SECTION_CAMERA = 3,    /* ring of ls_camera_record; line */
  LS_SECTION_TEXTS = 4,     /* a ring of ls_text_record per text (ls_text_kind); state */
  LS_SECTION_POSES = 5,     /* a ring of ls_pose_record per station; pose */
  LS_SECTION_SCANS = 6,     /* ring of ls_scan_record, record number = generation - 1; line */
  LS_SECTION_LINES = 7,     /* array of ls_line_record; line */
  LS_SECTION_POINTS = 8,    /* array of ls_point; line */
  LS_SECTION_PICTURES = 9,  /* ring of ls_picture_record; line */
  LS_SECTION_FRAMES = 10,   /* ring of ls_frame_record; line */
  LS_SECTION_COUNTERS = 11, /* array of ls_counter; any */
  LS_SECTION_LATENCIES = 12 /* array of ls_latency; any */
};

struct ls_section {
  uint32_t kind;         /* enum ls_section_kind; unknown kinds are skipped */
  uint32_t record_bytes; /* distance of two records; never smaller than the structure below */
  uint64_t offset;       /* from the start of the segment; a multiple of 64 */
  uint64_t bytes;        /* of the whole section */
  uint32_t record_count; /* slots per ring, or elements of the array */
  uint32_t ring_count;   /* 0: flat array */
  uint64_t ring_bytes;   /* distance of two rings */
  uint64_t reserved;
};

/* First page. Bytes 0..2047 never change once the magic is LS_MAGIC. */
struct ls_header {
  uint64_t magic;
  uint32_t layout_major;
  uint32_t layout_minor;
  uint32_t endian_mark;
  uint32_t header_bytes;       /* LS_HEADER_BYTES */
  uint64_t total_bytes;        /* of the shared-memory object */
  uint64_t session_id;         /* random, never 0; another number means another writer */
  int64_t started_ns;          /* start of the writer, CLOCK_MONOTONIC */
  int64_t started_utc_ns;      /* the same instant, CLOCK_REALTIME (for people) */
  uint64_t writer_start_ticks; /* field 22 of /proc/PID/stat: tells a reused pid */
  uint64_t pid_namespace;      /* inode of /proc/self/ns/pid: a pid means nothing in another one */
  uint32_t writer_pid;
  uint32_t writer_uid;
  uint32_t section_count;
  uint32_t counter_count;   /* used elements of the counters */
  uint32_t latency_count;   /* used elements of the latencies */
  uint32_t picture_samples; /* room for ls_line_sample per picture */
  char program[48];         /* name and version of the writer, zero-terminated UTF-8 like all texts */
  char control_name[80];    /* name of the control segment, see control_layout.h */
  uint8_t reserved0[288];
  struct ls_section sections[LS_MAX_SECTIONS];
  uint8_t reserved1[384];
  /* changing part: one cache line per writing thread */
  uint64_t heartbeat_count; /* life: +1 at least every 50 ms */
  int64_t heartbeat_ns;     /* life: time of that beat */
  uint32_t closed;          /* life: 1 after an orderly end */
  uint8_t reserved2[44];
  uint32_t news; /* any: +1 with everything published; futex word, see docs/segment.md */
  uint8_t reserved3[60];
  uint64_t published;   /* line: generation << 32 | lines */
  uint64_t next_serial; /* line: serial the next line will get; lines ever published in this session */
  uint64_t points_used; /* line: used elements of the points, this generation */
  uint32_t scanning;    /* line: 1 while lines are taken */
  uint32_t full;        /* line: 0 no, 1 lines used up, 2 points used up */
  uint8_t reserved4[32];
  uint64_t replaced_by; /* a successor that took over: its session id */
  uint8_t reserved5[56];
  uint8_t reserved6[1792];
};

/* Starts every ring; the records follow at once. */
struct ls_ring {
  uint64_t head; /* records ever published; the newest is head - 1 */
  uint8_t reserved[56];
};

/* What the writer is doing. */
enum ls_state {
  LS_STATE_STARTING = 0,
  LS_STATE_IDLE = 1,
  LS_STATE_SCANNING = 2,
  LS_STATE_FULL = 3,
  LS_STATE_CAMERA_LOST = 4,
  LS_STATE_TRACKER_LOST = 5,
  LS_STATE_STOPPING = 6
};

struct ls_state_record {
  uint64_t index;   /* its own record number, as in every ring */
  int64_t since_ns; /* in this state since */
  uint32_t state;   /* enum ls_state */
  uint32_t reserved;
  char reason[232]; /* one sentence, may be empty */
};

/* State of a tool or device; a larger value is worth less. Numbers may be derived from OK only. */
enum ls_tool_state {
  LS_TOOL_OK = 0,
  LS_TOOL_DISTORTED_FIELD = 1,
  LS_TOOL_OUT_OF_VIEW = 2,
  LS_TOOL_STALE = 3,
  LS_TOOL_MISSING = 4,
  LS_TOOL_DISCONNECTED = 5,
  LS_TOOL_NEVER_SEEN = 6
};

enum ls_role {
  LS_ROLE_NONE = 0,
  LS_ROLE_ENDOSCOPE = 1,
  LS_ROLE_OBJECT = 2,
  LS_ROLE_HARVESTER = 3,
  LS_ROLE_OTHER = 4
};

struct ls_sensor_record {
  uint64_t index;
  int64_t time_ns;      /* of this statement */
  int64_t last_good_ns; /* last sample in state OK; 0: never */
  uint64_t samples;     /* received so far */
  uint64_t lost;        /* samples the tracker numbered but that never arrived */
  uint32_t role;        /* enum ls_role */
  uint32_t state;       /* enum ls_tool_state */
  float nominal_hz;     /* 0: unknown */
  uint32_t reserved;
  char name[32];    /* for people, for example "endoscope" */
  char reason[168]; /* one sentence when the state is not OK */
};

struct ls_camera_record {
  uint64_t index;
  int64_t time_ns;      /* of this statement */
  int64_t last_good_ns; /* last readable picture; 0: never */
  uint64_t frames;      /* received so far */
  uint32_t state;       /* enum ls_tool_state */
  uint32_t width;       /* px */
  uint32_t height;      /* px */
  float nominal_hz;     /* 0: unknown */
  float exposure_ms;    /* 0: unknown */
  uint32_t reserved;
  char name[64];    /* device, file or folder */
  char reason[136]; /* one sentence when the state is not OK */
};

enum ls_text_kind { LS_TEXT_CONFIGURATION = 0 /* TOML */, LS_TEXT_CALIBRATION = 1 /* OpenCV YAML */ };

struct ls_text_record {
  uint64_t index;
  int64_t time_ns;
  uint32_t text_bytes; /* length of the UTF-8 text that follows this structure, without a zero */
  uint32_t reserved[3];
};

struct ls_pose_record {
  uint64_t index;
  int64_t time_ns;      /* acquisition */
  double position[3];   /* mm, world */
  double quaternion[4]; /* w x y z, world from sensor */
  uint32_t frame_count; /* the tracker's own running number */
  float distortion;     /* metal indicator, NaN: none */
  uint32_t station;     /* 0-based */
  uint32_t state;       /* enum ls_tool_state; the pose means nothing unless OK */
  uint64_t reserved;
};

/* Why a generation began. */
enum ls_scan_cause { LS_SCAN_NEW = 0, LS_SCAN_CLEARED = 1, LS_SCAN_UNDONE = 2 };

struct ls_scan_record {
  uint64_t index;        /* generation - 1 */
  int64_t started_ns;    /* of the scan (an undo keeps the scan's start) */
  uint64_t first_serial; /* serial of the first line that is new in this generation */
  uint32_t generation;
  uint32_t scan_id;    /* 1, 2 ...; an undo keeps it */
  uint32_t kept_lines; /* lines 0 .. kept_lines-1 come from the generation before (undo) */
  uint32_t cause;      /* enum ls_scan_cause */
  uint8_t reserved[24];
};

/* Pose of a tool at a line's instant: endoscope, object, harvester in this order. */
struct ls_line_pose {
  double position[3];   /* mm, world */
  double quaternion[4]; /* w x y z, world from tool */
  uint32_t state;       /* enum ls_tool_state */
  uint32_t reserved;
};

struct ls_line_record {
  uint64_t serial;      /* running number over the whole session; gaps tell what was missed */
  int64_t time_ns;      /* middle of the exposure */
  uint64_t frame;       /* running number of the camera's picture */
  uint64_t first_point; /* element of the points; always even */
  uint32_t point_count; /* an odd count is followed by one unused point of NaN */
  uint32_t scan_id;
  uint32_t index; /* in its scan */
  uint32_t reserved0;
  struct ls_line_pose poses[LS_TOOLS];
  float mean_peak;      /* grey levels */
  float mean_width;     /* px */
  float mean_snr;       /* signal to noise, ratio */
  float mean_deviation; /* mm, along the viewing direction */
  float coverage;       /* columns (or rows) with a point / all, 0..1 */
  uint32_t rejected;    /* candidates of this picture that gave no point */
  int64_t pose_gap_ns;  /* distance of the two endoscope samples between which the pose was interpolated */
  uint8_t reserved1[40];
  uint64_t checksum; /* of the 39 words before it and the words of the points (docs/segment.md) */
};

struct ls_point {
  float position[3];        /* mm, world */
  float intensity;          /* peak of the line there, 0..255 */
  float standard_deviation; /* mm, along the viewing direction */
};

enum ls_pixel_format { LS_PIXELS_GRAY8 = 1, LS_PIXELS_BGR8 = 2 };

/* Followed by picture_samples times ls_line_sample, then by the pixels, row by row. */
struct ls_picture_record {
  uint64_t index;
  int64_t time_ns;       /* middle of the exposure */
  uint64_t frame;        /* running number of the camera's picture */
  uint32_t width;        /* px */
  uint32_t height;       /* px */
  uint32_t stride;       /* bytes from row to row, a multiple of 8 */
  uint32_t format;       /* enum ls_pixel_format */
  uint32_t sample_count; /* used ls_line_sample */
  uint32_t reserved;
  char name[64]; /* file name, may be empty */
  uint64_t reserved1;
};

/* A point of the line in the picture, as extracted. */
struct ls_line_sample {
  float u;    /* px, column, centre of the first pixel is 0 */
  float v;    /* px, row */
  float peak; /* grey levels */
  float snr;  /* signal to noise, ratio */
};

/* One per picture that arrived: rates and gaps of the camera without reading pictures. */
struct ls_frame_record {
  uint64_t index;
  int64_t time_ns;      /* middle of the exposure */
  uint64_t frame;       /* running number of the camera's picture */
  int64_t published_ns; /* when it was in the segment */
};

struct ls_counter {
  char name[48]; /* for example "frames_received"; the order is that of segment_counters.h */
  uint64_t value;
  uint64_t reserved;
};

/* Histogram of durations: a value of v ns falls into bucket 0 below 256, else with e = floor(log2 v) into
 * bucket min(127, 4 (e - 8) + ((v >> (e - 2)) & 3)): four buckets per octave up to 2^40 ns. */
enum { LS_LATENCY_BUCKETS = 128 };
struct ls_latency {
  char name[32];
  uint64_t count;
  uint64_t sum_ns;
  uint64_t max_ns;
  uint64_t last_ns;
  uint64_t buckets[LS_LATENCY_BUCKETS];
};

#ifdef __cplusplus
}
#endif

#include "ipc/segment_layout_check.h"

#endif /* LINESCOPE_IPC_SEGMENT_LAYOUT_H */
