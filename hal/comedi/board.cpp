#include "hal/comedi/board.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "config/schema/error.h"

namespace hal::comedi {
namespace {

using config::schema::bad_config;

struct KindNames {
  int type;
  const char* what;
  const char* plural;
};

constexpr KindNames kKinds[] = {{COMEDI_SUBD_AI, "analogue input", "analogue inputs"},
                                {COMEDI_SUBD_AO, "analogue output", "analogue outputs"},
                                {COMEDI_SUBD_COUNTER, "counter", "counters"}};

const KindNames& names(ChannelKind kind) { return kKinds[static_cast<int>(kind)]; }

unsigned aref_of(const std::string& name) {
  if (name == "common") return AREF_COMMON;
  if (name == "diff") return AREF_DIFF;
  return name == "other" ? AREF_OTHER : AREF_GROUND;
}

/// "subdevices 0, 2".
std::string all_of(comedi_t* board, ChannelKind kind) {
  std::string list;
  for (int i = 0; i < comedi_get_n_subdevices(board); ++i) {
    if (comedi_get_subdevice_type(board, static_cast<unsigned>(i)) != names(kind).type) continue;
    list += (list.empty() ? "" : ", ") + std::to_string(i);
  }
  return list;
}

std::string up_to(const char* what, int count) {
  return std::string(what) + " 0 to " + std::to_string(count - 1);
}

}  // namespace

ComediBoard::ComediBoard(const std::string& where, const std::string& device) {
  comedi_loglevel(0);
  errno = 0;
  board_.reset(comedi_open(device.c_str()));
  if (board_ == nullptr) {
    const char* why = access(device.c_str(), F_OK) != 0 ? "no such device"
                      : errno != 0                      ? std::strerror(errno)
                                                        : comedi_strerror(comedi_errno());
    throw config::schema::DeviceUnavailable(config::schema::error_line(
        where, "is \"" + device + "\": " + why,
        "a configured comedi board such as /dev/comedi0, which this user may open"));
  }
}

BoardChannel ComediBoard::find(const std::string& table, ChannelKind kind,
                               const ChannelConfig& wanted) const {
  comedi_t* board = board_.get();
  const std::string name = comedi_get_board_name(board);
  const std::string fitting = all_of(board, kind);
  if (fitting.empty()) {
    throw bad_config(table + " subdevice", "needs one with " + std::string(names(kind).plural),
                     "a board that has them; " + name + " has none");
  }
  const int subdevice = wanted.subdevice >= 0
                            ? static_cast<int>(wanted.subdevice)
                            : comedi_find_subdevice_by_type(board, names(kind).type, 0);
  const auto index = static_cast<unsigned>(subdevice);
  if (subdevice >= comedi_get_n_subdevices(board) ||
      comedi_get_subdevice_type(board, index) != names(kind).type) {
    throw bad_config(table + " subdevice",
                     "is " + std::to_string(subdevice) + ", which is no " + names(kind).what,
                     fitting + " of " + name);
  }
  const int channels = comedi_get_n_channels(board, index);
  if (wanted.channel >= channels) {
    throw bad_config(table + " channel", "is " + std::to_string(wanted.channel),
                     up_to("channels", channels) + " of subdevice " + std::to_string(subdevice));
  }
  const auto channel = static_cast<unsigned>(wanted.channel);
  const int ranges = kind == ChannelKind::counter ? 1 : comedi_get_n_ranges(board, index, channel);
  if (wanted.range >= ranges) {
    throw bad_config(table + " range", "is " + std::to_string(wanted.range),
                     up_to("ranges", ranges) + " of subdevice " + std::to_string(subdevice));
  }
  return {index, channel, static_cast<unsigned>(wanted.range), aref_of(wanted.aref)};
}

ConverterSpan ComediBoard::span(const std::string& table, const BoardChannel& place) const {
  const comedi_range* range =
      comedi_get_range(board_.get(), place.subdevice, place.channel, place.range);
  if (range == nullptr || range->unit != UNIT_volt) {
    throw bad_config(table + " range", "is " + std::to_string(place.range) + ", which is not volts",
                     "a range in volts");
  }
  return {range->min, range->max, max_code(place)};
}

void ComediBoard::lock(const std::string& table, const BoardChannel& place) const {
  if (comedi_lock(board_.get(), place.subdevice) < 0) {
    throw bad_config(table + " subdevice",
                     "is " + std::to_string(place.subdevice) + ", which another program has locked",
                     "a free subdevice");
  }
}

std::uint32_t ComediBoard::max_code(const BoardChannel& place) const {
  return comedi_get_maxdata(board_.get(), place.subdevice, place.channel);
}

bool ComediBoard::write(const BoardChannel& place, std::uint32_t code) noexcept {
  return comedi_data_write(board_.get(), place.subdevice, place.channel, place.range, place.aref,
                           code) == 1;
}

std::optional<std::uint32_t> ComediBoard::read(const BoardChannel& place) noexcept {
  lsampl_t code = 0;
  if (comedi_data_read(board_.get(), place.subdevice, place.channel, place.range, place.aref,
                       &code) != 1) {
    return std::nullopt;
  }
  return code;
}

}  // namespace hal::comedi
