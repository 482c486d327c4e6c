/* The layout of the control segment, version 1.0: plain C (C11 and C++20). Viewers map it read-write.
 *
 * docs/segment.md explains the life of a slot. A slot's `word` is ticket << 8 | state; it is changed by
 * compare-and-swap only, and every part of a slot belongs to the side that the state names.
 */
#ifndef LINESCOPE_IPC_CONTROL_LAYOUT_H
#define LINESCOPE_IPC_CONTROL_LAYOUT_H

#include <stddef.h>
#include <stdint.h>

#define LS_CONTROL_MAGIC UINT64_C(0x4c52544353454e4c) /* the bytes "LNESCTRL" */
#define LS_CONTROL_VERSION 1u
enum { LS_CONTROL_SLOTS = 64 };

enum ls_command {
  LS_COMMAND_START = 1,
  LS_COMMAND_STOP = 2,
  LS_COMMAND_CLEAR = 3,
  LS_COMMAND_NEW_SCAN = 4,
  LS_COMMAND_UNDO_SWEEP = 5,
  LS_COMMAND_SAVE = 6,             /* text: file */
  LS_COMMAND_EXPOSURE = 7,         /* number: ms */
  LS_COMMAND_LASER_BRIGHTNESS = 8, /* number: 0 .. 1 */
  LS_COMMAND_SHUT_DOWN = 9
};

enum ls_answer { LS_ANSWER_DONE = 1, LS_ANSWER_REFUSED = 2, LS_ANSWER_UNKNOWN = 3 };

enum ls_slot_state {
  LS_SLOT_FREE = 0,
  LS_SLOT_CLAIMED = 1, /* a sender is writing the request */
  LS_SLOT_SENT = 2,    /* the request is complete */
  LS_SLOT_TAKEN = 3,   /* the daemon is at it */
  LS_SLOT_ANSWERED = 4 /* the answer is complete; the sender frees the slot */
};

struct ls_request {
  uint32_t command; /* enum ls_command */
  uint32_t sender_pid;
  int64_t sent_ns;
  double number;
  uint32_t text_bytes;
  uint32_t reserved;
  char text[88];
  uint64_t checksum; /* of the 15 words before it, started with the ticket as first word */
};

struct ls_reply {
  uint32_t answer; /* enum ls_answer */
  uint32_t text_bytes;
  int64_t answered_ns;
  char text[112];
};

struct ls_slot {
  uint64_t word;     /* ticket << 8 | enum ls_slot_state */
  uint32_t answered; /* futex word: +1 with the answer */
  uint8_t reserved[52];
  struct ls_request request;
  struct ls_reply reply;
};

struct ls_control {
  uint64_t magic;
  uint32_t version;
  uint32_t slot_count;
  uint64_t total_bytes;
  uint64_t session_id; /* of the segment it belongs to */
  uint8_t reserved0[32];
  uint64_t next_ticket; /* senders: +1 per command; order of sending */
  uint8_t reserved1[56];
  uint32_t bell; /* senders: +1 with every command; futex word of the daemon */
  uint8_t reserved2[60];
  uint32_t listens; /* daemon: 1 while it sleeps on the bell */
  uint8_t reserved3[60];
  uint32_t sleepers; /* readers: bits of the topics somebody sleeps for; the writer clears and wakes */
  uint8_t reserved4[60];
  struct ls_slot slots[LS_CONTROL_SLOTS];
};

#ifdef __cplusplus
#define LS_STATIC_ASSERT_C(condition, text) static_assert(condition, text)
#else
#define LS_STATIC_ASSERT_C(condition, text) _Static_assert(condition, text)
#endif
#define LS_ASSERT_AT(type, member, offset) \
  LS_STATIC_ASSERT_C(offsetof(struct type, member) == (offset), #type "." #member " moved")
#define LS_ASSERT_SIZE(type, size) \
  LS_STATIC_ASSERT_C(sizeof(struct type) == (size), #type " changed its size")

LS_ASSERT_AT(ls_request, command, 0);
LS_ASSERT_AT(ls_request, sender_pid, 4);
LS_ASSERT_AT(ls_request, sent_ns, 8);
LS_ASSERT_AT(ls_request, number, 16);
LS_ASSERT_AT(ls_request, text_bytes, 24);
LS_ASSERT_AT(ls_request, text, 32);
LS_ASSERT_AT(ls_request, checksum, 120);
LS_ASSERT_SIZE(ls_request, 128);
LS_ASSERT_AT(ls_reply, answer, 0);
LS_ASSERT_AT(ls_reply, text_bytes, 4);
LS_ASSERT_AT(ls_reply, answered_ns, 8);
LS_ASSERT_AT(ls_reply, text, 16);
LS_ASSERT_SIZE(ls_reply, 128);
LS_ASSERT_AT(ls_slot, word, 0);
LS_ASSERT_AT(ls_slot, answered, 8);
LS_ASSERT_AT(ls_slot, request, 64);
LS_ASSERT_AT(ls_slot, reply, 192);
LS_ASSERT_SIZE(ls_slot, 320);
LS_ASSERT_AT(ls_control, magic, 0);
LS_ASSERT_AT(ls_control, version, 8);
LS_ASSERT_AT(ls_control, slot_count, 12);
LS_ASSERT_AT(ls_control, total_bytes, 16);
LS_ASSERT_AT(ls_control, session_id, 24);
LS_ASSERT_AT(ls_control, next_ticket, 64);
LS_ASSERT_AT(ls_control, bell, 128);
LS_ASSERT_AT(ls_control, listens, 192);
LS_ASSERT_AT(ls_control, sleepers, 256);
LS_ASSERT_AT(ls_control, slots, 320);
LS_ASSERT_SIZE(ls_control, 320 + 64 * 320);

#undef LS_ASSERT_AT
#undef LS_ASSERT_SIZE
#undef LS_STATIC_ASSERT_C

#endif /* LINESCOPE_IPC_CONTROL_LAYOUT_H */
