// Attaching to what is not a good segment: one sentence each, nothing followed.
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <functional>

#include "tests/unit/ipc/raw_object.hpp"
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A copy of a good segment under another name, to be damaged before attaching.
class Attach : public SegmentTest {
 protected:
  void SetUp() override {
    SegmentTest::SetUp();
    writer_->set_scanning(true);
    publish(1, 10);
    bytes_ = RawObject::bytes_of(name_);
  }
  Error refused() {
    copy_.set(bytes_);
    auto attached = SegmentReader::attach({.name = copy_.name()});
    EXPECT_FALSE(attached);
    if (attached) return {};
    EXPECT_THAT(attached.error().message, HasSubstr(copy_.name())) << "the sentence says which segment";
    return attached.error();
  }
  ls_header& header() { return header_of(bytes_); }
  ls_section& section(ls_section_kind kind) {
    for (ls_section& s : header().sections) {
      if (s.kind == kind) return s;
    }
    throw std::runtime_error("no such section");
  }

  std::vector<std::byte> bytes_;
  RawObject copy_{unique_segment_name()};
};

TEST_F(Attach, AnUndamagedCopyIsAccepted) {
  copy_.set(bytes_);
  EXPECT_TRUE(SegmentReader::attach({.name = copy_.name()}));
}

TEST_F(Attach, TheIdentityIsThatOfTheWriter) {
  const SegmentIdentity& id = reader_->identity();
  EXPECT_EQ(id.session_id, writer_->session_id());
  EXPECT_EQ(id.writer_pid, static_cast<std::uint32_t>(::getpid()));
  EXPECT_EQ(id.writer_uid, ::geteuid());
  EXPECT_EQ(id.bytes, segment_bytes(small_segment(name_)));
  EXPECT_EQ(id.line_capacity, 50U);
  EXPECT_EQ(id.program, "linescope");
}

TEST_F(Attach, NoSuchSegment) {
  const auto attached = SegmentReader::attach({.name = unique_segment_name()});
  ASSERT_FALSE(attached);
  EXPECT_EQ(attached.error().code, ErrorCode::not_found);
  EXPECT_THAT(attached.error().message, HasSubstr("no linescope daemon"));
}

TEST_F(Attach, AnotherLayoutVersion) {
  header().layout_major = 2;
  header().layout_minor = 7;
  const Error error = refused();
  EXPECT_EQ(error.code, ErrorCode::mismatch);
  EXPECT_THAT(error.message, AllOf(HasSubstr("2.7"), HasSubstr("1.x")));
}

TEST_F(Attach, ALaterMinorVersionIsReadable) {
  header().layout_minor = 7;
  copy_.set(bytes_);
  EXPECT_TRUE(SegmentReader::attach({.name = copy_.name()}));
}

TEST_F(Attach, AnotherByteOrder) {
  header().endian_mark = __builtin_bswap32(header().endian_mark);
  EXPECT_THAT(refused().message, HasSubstr("byte order"));
  header().magic = __builtin_bswap64(header().magic);
  EXPECT_THAT(refused().message, HasSubstr("byte order"));
}

TEST_F(Attach, SomethingElse) {
  std::memcpy(bytes_.data(), "GIF89a..", 8);
  const Error error = refused();
  EXPECT_EQ(error.code, ErrorCode::mismatch);
  EXPECT_THAT(error.message, HasSubstr("no linescope segment"));
}

TEST_F(Attach, BeingSetUp) {
  header().magic = LS_MAGIC_CREATING;
  EXPECT_EQ(refused().code, ErrorCode::busy);
  bytes_.clear();
  EXPECT_EQ(refused().code, ErrorCode::busy);
}

TEST_F(Attach, Truncated) {
  bytes_.resize(bytes_.size() - 1);
  EXPECT_EQ(refused().code, ErrorCode::unreadable);
  bytes_.resize(4096);
  EXPECT_THAT(refused().message, AllOf(HasSubstr("4096"), HasSubstr("truncated")));
  bytes_.resize(100);
  EXPECT_THAT(refused().message, AllOf(HasSubstr("100"), HasSubstr("truncated")));
}

TEST_F(Attach, LongerThanItsHeaderSays) {
  bytes_.resize(bytes_.size() + 4096);
  EXPECT_EQ(refused().code, ErrorCode::unreadable);
}

TEST_F(Attach, EveryImpossibleTableEntryIsRefused) {
  const std::vector<std::byte> good = bytes_;
  const std::vector<std::function<void(ls_section&)>> damages{
      [](ls_section& s) { s.offset += 1; },
      [](ls_section& s) { s.offset = 0; },
      [](ls_section& s) { s.offset = UINT64_MAX / 64 * 64; },
      [](ls_section& s) { s.bytes = UINT64_MAX; },
      [](ls_section& s) { s.record_bytes = 0; },
      [](ls_section& s) { s.record_bytes = 0x7ffffff8; },
      [](ls_section& s) { s.record_count = 0; },
      [](ls_section& s) { s.record_count = UINT32_MAX; },
      [](ls_section& s) { s.ring_count += 1; },
      [](ls_section& s) { s.kind = 999; },
  };
  for (std::uint32_t kind = 1; kind <= LS_SECTION_LATENCIES; ++kind) {
    for (std::size_t d = 0; d < damages.size(); ++d) {
      SCOPED_TRACE("section " + std::to_string(kind) + ", damage " + std::to_string(d));
      bytes_ = good;
      damages[d](section(static_cast<ls_section_kind>(kind)));
      copy_.set(bytes_);
      const auto attached = SegmentReader::attach({.name = copy_.name()});
      ASSERT_FALSE(attached);
      EXPECT_EQ(attached.error().code, ErrorCode::unreadable);
    }
  }
}

TEST_F(Attach, ImpossibleCountsInTheHeaderAreRefused) {
  const std::vector<std::byte> good = bytes_;
  header().section_count = 25;
  EXPECT_THAT(refused().message, HasSubstr("damaged"));
  bytes_ = good;
  header().counter_count = 129;
  EXPECT_THAT(refused().message, HasSubstr("damaged"));
  bytes_ = good;
  header().latency_count = UINT32_MAX;
  EXPECT_THAT(refused().message, HasSubstr("damaged"));
  bytes_ = good;
  header().picture_samples = UINT32_MAX;
  EXPECT_THAT(refused().message, HasSubstr("damaged"));
  bytes_ = good;
  header().session_id = 0;
  EXPECT_THAT(refused().message, HasSubstr("damaged"));
}

/// Runs `body` in a child as the user nobody; 0 when it returned true.
int as_nobody(const std::function<bool()>& body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(::setgid(65534) == 0 && ::setuid(65534) == 0 && body() ? 0 : 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

TEST_F(Attach, ModeZeroIsExplained) {
  if (::geteuid() != 0) {
    copy_.set(bytes_, 0);
    const auto attached = SegmentReader::attach({.name = copy_.name()});
    ASSERT_FALSE(attached);
    EXPECT_EQ(attached.error().code, ErrorCode::permission);
    return;
  }
  copy_.set(bytes_, 0);  // root may open it all the same: look with other eyes
  EXPECT_EQ(as_nobody([&] {
              const auto attached = SegmentReader::attach({.name = copy_.name()});
              return !attached && attached.error().code == ErrorCode::permission &&
                     attached.error().message.find("belongs to root (mode 0)") != std::string::npos;
            }),
            0);
}

TEST_F(Attach, ASegmentOfAnotherUserIsOnlyReadWhenAskedFor) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give an object to somebody else";
  copy_.set(bytes_);
  ASSERT_EQ(::chown(("/dev/shm/" + copy_.name()).c_str(), 65534, 65534), 0);
  const auto attached = SegmentReader::attach({.name = copy_.name()});
  ASSERT_FALSE(attached);
  EXPECT_EQ(attached.error().code, ErrorCode::permission);
  EXPECT_THAT(attached.error().message, HasSubstr("nobody"));
  EXPECT_TRUE(SegmentReader::attach({.name = copy_.name(), .other_owner = true}));
}

TEST_F(Attach, DamagedContentsAreReportedNotFollowed) {
  const auto corrupt_line = [&](const std::function<void(ls_line_record&)>& damage) {
    bytes_ = RawObject::bytes_of(name_);
    damage(*reinterpret_cast<ls_line_record*>(bytes_.data() + section(LS_SECTION_LINES).offset));
    copy_.set(bytes_);
    auto reader = SegmentReader::attach({.name = copy_.name()});
    LineCursor cursor;
    LineBatch batch;
    return reader->read_lines(cursor, batch);
  };
  EXPECT_EQ(corrupt_line([](ls_line_record&) {}), ReadOutcome::ok);
  EXPECT_EQ(corrupt_line([](ls_line_record& r) { r.first_point = 1'999; }), ReadOutcome::corrupt);
  EXPECT_EQ(corrupt_line([](ls_line_record& r) { r.first_point = UINT64_MAX - 1; }), ReadOutcome::corrupt);
  EXPECT_EQ(corrupt_line([](ls_line_record& r) { r.point_count = 2'001; }), ReadOutcome::corrupt);
  EXPECT_EQ(corrupt_line([](ls_line_record& r) { r.point_count = UINT32_MAX; }), ReadOutcome::corrupt);
  EXPECT_EQ(corrupt_line([](ls_line_record& r) { r.serial = 77; }), ReadOutcome::corrupt);
  EXPECT_EQ(corrupt_line([](ls_line_record& r) { r.index = 1; }), ReadOutcome::corrupt);
}

TEST_F(Attach, AChangedPointIsFoundByTheChecksum) {
  bytes_[section(LS_SECTION_POINTS).offset + 7] ^= std::byte{1};
  copy_.set(bytes_);
  auto reader = SegmentReader::attach({.name = copy_.name()});
  LineCursor cursor;
  LineBatch batch;
  EXPECT_EQ(reader->read_lines(cursor, batch), ReadOutcome::ok);
  EXPECT_EQ(batch.damaged, 1U);
  EXPECT_TRUE(batch.lines.empty());
  EXPECT_TRUE(batch.points.empty());
}

TEST_F(Attach, MoreLinesThanThereIsRoomForIsCorrupt) {
  header().published = (std::uint64_t{1} << 32) | 51;
  copy_.set(bytes_);
  auto reader = SegmentReader::attach({.name = copy_.name()});
  LineCursor cursor;
  LineBatch batch;
  EXPECT_EQ(reader->read_lines(cursor, batch), ReadOutcome::corrupt);
}

}  // namespace
}  // namespace linescope::testing
