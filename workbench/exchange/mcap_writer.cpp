#include "workbench/exchange/mcap_writer.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>

namespace workbench::exchange {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = 1U << 20U;

enum class McapOpcode : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F
};

/// Little endian; texts and arrays behind their length.
class Bytes {
 public:
  Bytes& u16(std::uint64_t value) { return number(value, 2); }
  Bytes& u32(std::uint64_t value) { return number(value, 4); }
  Bytes& u64(std::uint64_t value) { return number(value, 8); }
  Bytes& text(std::string_view value) { return u32(value.size()).raw(value); }
  Bytes& raw(std::string_view value) {
    bytes_ += value;
    return *this;
  }
  [[nodiscard]] const std::string& get() const { return bytes_; }

 private:
  Bytes& number(std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) bytes_ += static_cast<char>(value >> (8 * i));
    return *this;
  }
  std::string bytes_;
};

std::string record_of(McapOpcode op, const Bytes& content) {
  return Bytes()
      .raw({reinterpret_cast<const char*>(&op), 1})
      .u64(content.get().size())
      .raw(content.get())
      .get();
}

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

void McapWriter::Span::add(std::uint64_t t_ns) {
  first_ns = std::min(first_ns, t_ns);
  last_ns = std::max(last_ns, t_ns);
}

McapWriter::McapWriter(std::string_view library) : file_(kMagic) {
  file_ += record_of(McapOpcode::header, Bytes().text("").text(library));
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& schema_name,
                                      std::string_view schema) {
  const auto number = static_cast<std::uint16_t>(counts_.size() + 1);
  counts_[number] = 0;
  const std::string schema_record = record_of(
      McapOpcode::schema, Bytes().u16(number).text(schema_name).text("jsonschema").text(schema));
  const std::string channel_record = record_of(
      McapOpcode::channel, Bytes().u16(number).u16(number).text(topic).text("json").u32(0));
  chunk_ += schema_record + channel_record;
  schemas_ += schema_record;
  channels_ += channel_record;
  return number;
}

void McapWriter::add(std::uint16_t channel, std::int64_t t_ns, std::string_view json) {
  const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(t_ns, 0));
  chunk_entries_[channel].push_back({time, chunk_.size()});
  const std::uint64_t sequence = counts_[channel]++;
  chunk_ += record_of(McapOpcode::message,
                      Bytes().u16(channel).u32(sequence).u64(time).u64(time).raw(json));
  chunk_span_.add(time);
  span_.add(time);
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  if (chunk_entries_.empty()) chunk_span_ = {0, 0};
  const std::uint64_t chunk_start = file_.size();
  file_ += record_of(McapOpcode::chunk, Bytes()
                                            .u64(chunk_span_.first_ns)
                                            .u64(chunk_span_.last_ns)
                                            .u64(chunk_.size())
                                            .u32(crc_of(chunk_))
                                            .text("")
                                            .u64(chunk_.size())
                                            .raw(chunk_));
  const std::uint64_t indexes_start = file_.size();
  Bytes offsets;
  for (auto& [channel, entries] : chunk_entries_) {
    offsets.u16(channel).u64(file_.size());
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.t_ns < b.t_ns; });
    Bytes pairs;
    for (const Entry& entry : entries) pairs.u64(entry.t_ns).u64(entry.offset);
    file_ += record_of(McapOpcode::message_index, Bytes().u16(channel).text(pairs.get()));
  }
  chunk_indexes_ += record_of(McapOpcode::chunk_index, Bytes()
                                                           .u64(chunk_span_.first_ns)
                                                           .u64(chunk_span_.last_ns)
                                                           .u64(chunk_start)
                                                           .u64(indexes_start - chunk_start)
                                                           .text(offsets.get())
                                                           .u64(file_.size() - indexes_start)
                                                           .text("")
                                                           .u64(chunk_.size())
                                                           .u64(chunk_.size()));
  ++chunk_count_;
  chunk_.clear();
  chunk_span_ = {};
  chunk_entries_.clear();
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0;
  Bytes counts;
  for (const auto& [channel, count] : counts_) {
    messages += count;
    counts.u16(channel).u64(count);
  }
  return record_of(McapOpcode::statistics, Bytes()
                                               .u64(messages)
                                               .u16(counts_.size())  // a schema for each channel
                                               .u32(counts_.size())
                                               .u32(0)
                                               .u32(0)
                                               .u32(chunk_count_)
                                               .u64(messages == 0 ? 0 : span_.first_ns)
                                               .u64(span_.last_ns)
                                               .text(counts.get()));
}

std::string McapWriter::finish() {
  end_chunk();
  file_ += record_of(McapOpcode::data_end, Bytes().u32(crc_of(file_)));
  const std::uint64_t summary_start = file_.size();
  std::string offsets;
  const auto add_group = [&](McapOpcode op, const std::string& records) {
    if (records.empty()) return;
    const std::uint64_t start = file_.size();
    file_ += records;
    offsets += record_of(
        McapOpcode::summary_offset,
        Bytes().raw({reinterpret_cast<const char*>(&op), 1}).u64(start).u64(records.size()));
  };
  add_group(McapOpcode::schema, schemas_);
  add_group(McapOpcode::channel, channels_);
  add_group(McapOpcode::statistics, statistics());
  add_group(McapOpcode::chunk_index, chunk_indexes_);
  end_file(summary_start, offsets);
  return std::move(file_);
}

void McapWriter::end_file(std::uint64_t summary_start, const std::string& offsets) {
  const std::uint64_t offsets_start = file_.size();
  file_ += offsets;
  // The check sum covers the summary and the footer up to the sum itself.
  const Bytes places = Bytes().u64(summary_start).u64(offsets_start);
  const std::string footer = record_of(McapOpcode::footer, Bytes(places).u32(0));
  file_ += footer.substr(0, footer.size() - 4);
  file_ += Bytes().u32(crc_of(std::string_view(file_).substr(summary_start))).get();
  file_ += kMagic;
}

}  // namespace workbench::exchange
