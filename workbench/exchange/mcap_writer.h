// Writes MCAP, the container of Foxglove and PlotJuggler (https://mcap.dev/spec, version 0): JSON
// messages with JSON-schema channels, in chunks with an index, uncompressed, with check sums.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace workbench::exchange {

class McapWriter {
 public:
  explicit McapWriter(std::string_view library);

  /// A channel for JSON objects of this JSON schema; its number for add().
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name,
                            std::string_view schema);
  /// `json` is one object. Times need not ascend.
  void add(std::uint16_t channel, std::int64_t t_ns, std::string_view json);
  /// The whole file; nothing can be added after.
  [[nodiscard]] std::string finish();

 private:
  struct Span {
    std::uint64_t first_ns = UINT64_MAX;
    std::uint64_t last_ns = 0;
    void add(std::uint64_t t_ns);
  };
  struct Entry {
    std::uint64_t t_ns;
    std::uint64_t offset;  ///< within the chunk
  };

  void end_chunk();
  [[nodiscard]] std::string statistics() const;
  void end_file(std::uint64_t summary_start, const std::string& offsets);

  std::string file_;
  std::string chunk_;  ///< messages not yet in the file
  Span chunk_span_;
  std::map<std::uint16_t, std::vector<Entry>> chunk_entries_;
  std::string schemas_;        ///< records, repeated at the end
  std::string channels_;       ///< records, repeated at the end
  std::string chunk_indexes_;  ///< records
  std::uint32_t chunk_count_ = 0;
  Span span_;
  std::map<std::uint16_t, std::uint64_t> counts_;  ///< messages by channel
};

}  // namespace workbench::exchange
