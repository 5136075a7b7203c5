#include "net/download/zip_archive.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace heliograph::net {
namespace {

constexpr std::uint32_t most_32 = 0xffffffff;
constexpr std::uint16_t most_16 = 0xffff;
constexpr std::uint16_t names_are_utf8 = 1 << 11;
constexpr std::uint16_t zip64_version = 45;
constexpr std::uint16_t made_on_unix = 3 << 8;
constexpr std::uint32_t regular_file = 0100644u << 16;
constexpr std::uint16_t zip64_extra = 1;

/// Little-endian numbers.
class Record {
 public:
  Record& u16(std::uint64_t value) { return number(value, 2); }
  Record& u32(std::uint64_t value) { return number(value, 4); }
  Record& u64(std::uint64_t value) { return number(value, 8); }
  Record& text(const std::string& value) {
    bytes_ += value;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  Record& number(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
    return *this;
  }
  std::string bytes_;
};

std::uint64_t in_32(std::uint64_t value) {
  return std::min<std::uint64_t>(value, most_32);
}

/// MS-DOS: the date in the upper half, the time in units of two seconds in the lower. UTC.
std::uint32_t dos_time(double seconds) {
  using namespace std::chrono;
  const auto time = floor<std::chrono::seconds>(
      system_clock::time_point(duration_cast<system_clock::duration>(duration<double>(seconds))));
  const auto day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(time - day);
  const auto year =
      static_cast<std::uint32_t>(std::clamp(static_cast<int>(date.year()), 1980, 2107));
  const auto of_day = static_cast<std::uint32_t>(
      clock.hours().count() << 11 | clock.minutes().count() << 5 | clock.seconds().count() / 2);
  return ((year - 1980) << 9 | static_cast<unsigned>(date.month()) << 5 |
          static_cast<unsigned>(date.day()))
             << 16 |
         of_day;
}

/// The members that local and central headers share: from "version needed" to the length of the
/// name.
void add_description(Record& record, const ZipEntry& entry, std::uint32_t time) {
  record.u16(zip64_version).u16(names_are_utf8).u16(0).u32(time).u32(entry.crc);
  record.u32(in_32(entry.bytes)).u32(in_32(entry.bytes)).u16(entry.name.size());
}

std::string local_header(const ZipEntry& entry, std::uint32_t time) {
  Record extra;
  if (entry.bytes >= most_32) {
    extra.u16(zip64_extra).u16(16).u64(entry.bytes).u64(entry.bytes);
  }
  Record header;
  header.u32(0x04034b50);
  add_description(header, entry, time);
  header.u16(extra.bytes().size()).text(entry.name).text(extra.bytes());
  return header.bytes();
}

std::string central_header(const ZipEntry& entry, std::uint32_t time, std::uint64_t offset) {
  Record large;
  if (entry.bytes >= most_32) large.u64(entry.bytes).u64(entry.bytes);
  if (offset >= most_32) large.u64(offset);
  Record extra;
  if (!large.bytes().empty()) {
    extra.u16(zip64_extra).u16(large.bytes().size()).text(large.bytes());
  }
  Record header;
  header.u32(0x02014b50).u16(made_on_unix | zip64_version);
  add_description(header, entry, time);
  header.u16(extra.bytes().size()).u16(0).u16(0).u16(0).u32(regular_file).u32(in_32(offset));
  header.text(entry.name).text(extra.bytes());
  return header.bytes();
}

std::string end_of_directory(std::uint64_t count, std::uint64_t size, std::uint64_t offset) {
  Record end;
  if (count >= most_16 || size >= most_32 || offset >= most_32) {
    end.u32(0x06064b50).u64(44).u16(made_on_unix | zip64_version).u16(zip64_version).u32(0).u32(0);
    end.u64(count).u64(count).u64(size).u64(offset);
    end.u32(0x07064b50).u32(0).u64(offset + size).u32(1);
  }
  const std::uint64_t short_count = std::min<std::uint64_t>(count, most_16);
  end.u32(0x06054b50).u16(0).u16(0).u16(short_count).u16(short_count);
  end.u32(in_32(size)).u32(in_32(offset)).u16(0);
  return end.bytes();
}

}  // namespace

Content zip_archive(const std::vector<ZipEntry>& entries, double seconds) {
  const std::uint32_t time = dos_time(seconds);
  Content archive;
  std::string directory;
  for (const ZipEntry& entry : entries) {
    directory += central_header(entry, time, archive.size());
    archive.add(local_header(entry, time));
    archive.add_file(entry.file, entry.bytes);
  }
  const std::string end = end_of_directory(entries.size(), directory.size(), archive.size());
  archive.add(std::move(directory) + end);
  return archive;
}

}  // namespace heliograph::net
