// Damage of every kind: no wrong record is ever given out, and every record outside of the damage is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "acquire/record/record_file.hpp"
#include "tests/support/child_process.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

class RecordFile : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kCount = 5;

  std::filesystem::path file() const { return folder / "a.lsrec"; }

  static Bytes payload(std::uint32_t i) { return Bytes(3 + 11 * i, static_cast<std::uint8_t>('a' + i)); }

  void write(RecordFileKind kind = RecordFileKind::tracker) const {
    auto sink = create_record_file(file());
    ASSERT_TRUE(sink);
    RecordWriter writer(std::move(*sink), kind);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      writer.begin(i).raw(payload(i).data(), payload(i).size());
      writer.end();
      ASSERT_TRUE(writer.flush());
    }
  }
  Bytes content() const {
    std::ifstream stream(file(), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void put(const Bytes& bytes) const {
    std::ofstream(file(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }

  struct Outcome {
    std::vector<std::uint32_t> good;
    int damaged = 0;
    std::uint64_t unfinished = 0;
    bool opened = false;
  };
  /// Reads to the end; fails the test when a record is not exactly as written.
  Outcome read() const {
    Outcome outcome;
    auto reader = RecordReader::open(file(), RecordFileKind::tracker);
    if (!reader) return outcome;
    outcome.opened = true;
    Record record;
    for (;;) {
      const auto pull = reader->next(record);
      if (pull && *pull == Pull::end) break;
      if (!pull) {
        EXPECT_EQ(pull.error().code, ErrorCode::unreadable);
        ++outcome.damaged;
        continue;
      }
      EXPECT_LT(record.type, kCount);
      EXPECT_EQ(record.payload, payload(record.type)) << "a wrong record was given out";
      outcome.good.push_back(record.type);
    }
    outcome.unfinished = reader->unfinished_bytes();
    return outcome;
  }

  testing::TemporaryFolder folder;
};

TEST_F(RecordFile, GivesBackWhatWasWritten) {
  write();
  const Outcome outcome = read();
  EXPECT_EQ(outcome.good, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(outcome.damaged, 0);
  EXPECT_EQ(outcome.unfinished, 0U);
}

TEST_F(RecordFile, ChecksumIsTheOneOfTheStandard) {
  // CRC-32 of the eight bytes 01 00 00 00 00 00 00 00: computed with Python's zlib.crc32.
  EXPECT_EQ(record_crc(1, {}), 0xA988DFF7U);
}

TEST_F(RecordFile, EverySingleDamagedByteCostsAtMostItsOwnRecord) {
  write();
  const Bytes good = content();
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] ^= 0x5A;
    put(bad);
    const Outcome outcome = read();
    if (at >= 6 && at < kRecordFileHeader) continue;  // version and kind: refused as a whole, tested below
    ASSERT_TRUE(outcome.opened) << at;
    EXPECT_GE(outcome.good.size(), at < kRecordFileHeader ? kCount : kCount - 1) << "byte " << at;
    EXPECT_EQ(outcome.damaged + (outcome.unfinished > 0 ? 1 : 0), 1) << "byte " << at << ": damage unnoticed";
  }
}

TEST_F(RecordFile, EveryTruncationKeepsTheWholeRecordsBeforeIt) {
  write();
  const Bytes good = content();
  std::vector<std::size_t> ends{kRecordFileHeader};
  for (std::uint32_t i = 0; i < kCount; ++i) ends.push_back(ends.back() + kRecordHeader + payload(i).size());
  ASSERT_EQ(ends.back(), good.size());
  for (std::size_t size = kRecordFileHeader; size <= good.size(); ++size) {
    put(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
    const Outcome outcome = read();
    std::size_t whole = 0;
    while (whole < kCount && ends[whole + 1] <= size) ++whole;
    EXPECT_EQ(outcome.good.size(), whole) << size;
    EXPECT_EQ(outcome.unfinished, size - ends[whole]) << size;
  }
}

TEST_F(RecordFile, InsertedGarbageIsPassedOver) {
  write();
  Bytes bytes = content();
  const Bytes garbage(70'000, 'L');
  bytes.insert(bytes.begin() + kRecordFileHeader + kRecordHeader + 3, garbage.begin(), garbage.end());
  put(bytes);
  const Outcome outcome = read();
  EXPECT_EQ(outcome.good, (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(outcome.damaged, 1);
}

TEST_F(RecordFile, LyingSizeDoesNotHideTheRecordsBehindIt) {
  write();
  Bytes bytes = content();
  bytes[kRecordFileHeader + 8] = 60;  // the first record claims to reach into the third
  put(bytes);
  EXPECT_EQ(read().good, (std::vector<std::uint32_t>{1, 2, 3, 4}));
}

TEST_F(RecordFile, OtherKindAndOtherVersionAreRefused) {
  write(RecordFileKind::pictures);
  const auto kind = RecordReader::open(file(), RecordFileKind::tracker);
  EXPECT_EQ(kind.error().code, ErrorCode::mismatch);
  Bytes bytes = content();
  bytes[6] = '2';
  put(bytes);
  const auto version = RecordReader::open(file(), RecordFileKind::pictures);
  EXPECT_EQ(version.error().code, ErrorCode::mismatch);
  EXPECT_THAT(version.error().message, HasSubstr("another version"));
}

TEST_F(RecordFile, MissingAndForeignFilesAreSentences) {
  EXPECT_EQ(RecordReader::open(folder / "none", RecordFileKind::tracker).error().code, ErrorCode::not_found);
  put({'t', 'e', 'x', 't'});
  const auto foreign = RecordReader::open(file(), RecordFileKind::tracker);
  EXPECT_EQ(foreign.error().code, ErrorCode::unreadable);
  EXPECT_THAT(foreign.error().message, HasSubstr("is not a recording"));
}

TEST_F(RecordFile, EmptyFileIsARecordingThatWasKilledAtOnce) {
  put({});
  const Outcome outcome = read();
  EXPECT_TRUE(outcome.opened);
  EXPECT_TRUE(outcome.good.empty());
}

TEST_F(RecordFile, ExistingFileIsNotOverwritten) {
  write();
  EXPECT_EQ(create_record_file(file()).error().code, ErrorCode::busy);
}

}  // namespace
}  // namespace linescope
