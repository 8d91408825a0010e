#include "hal/hil_rig/server.h"

#include <arpa/inet.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "config/schema/error.h"
#include "hal/hil_rig/register_map.h"
#include "hal/hil_rig/server_wire.h"
#include "hal/monotonic.h"

namespace hal::hil_rig {
namespace {

using config::schema::bad_config;

constexpr int kMostClients = 16;
/// A request incomplete after this time ends its connection.
constexpr std::uint32_t kWhole_us = 20'000;

void put_wide(std::uint16_t* registers, int at, std::uint32_t bits) {
  registers[at] = static_cast<std::uint16_t>(bits >> 16U);
  registers[at + 1] = static_cast<std::uint16_t>(bits);
}

void put_float(std::uint16_t* registers, int at, double value) {
  put_wide(registers, at, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

/// kPa as int16; the lowest number for a pressure that the plant lacks.
std::uint16_t kilopascals(double p_Pa) {
  const double rounded = std::isfinite(p_Pa) ? std::round(p_Pa * 1e-3) : -32768.0;
  return static_cast<std::uint16_t>(
      static_cast<std::int16_t>(std::clamp(rounded, -32768.0, 32767.0)));
}

void bound_waits(modbus_t* context) {
  modbus_set_byte_timeout(context, 0, kWhole_us);
  modbus_set_response_timeout(context, 0, 1000);  // delay before the answer to a bad request
}

}  // namespace

void Server::Free::operator()(modbus_t* context) const { modbus_free(context); }
void Server::Free::operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }

Server::Server(const RigConfig& config, BenchRig& rig)
    : rig_(rig),
      process_(modbus_mapping_new(1, 2, kRegisters, kRegisters)),
      text_(modbus_mapping_new_start_address(0, 0, 0, 0, kText, 2 * kTextRegisters, 0, 0)) {
  if (!config.bus.listen.empty()) listen(config);
  if (!config.bus.serial.empty()) open_serial(config);
  if (address_.empty() && serial_ == nullptr) {
    throw bad_config(config.file + ": [bus] listen", "is empty, and so is serial",
                     "an address, a serial line or both");
  }
}

Server::~Server() {
  for (const int client : clients_) close(client);
  if (listener_ >= 0) close(listener_);
  if (tcp_ != nullptr) modbus_set_socket(tcp_.get(), -1);
  if (serial_ != nullptr) modbus_close(serial_.get());
}

void Server::listen(const RigConfig& config) {
  const std::string where = config.file + ": [bus] listen";
  const auto place = split_address(config.bus.listen);
  if (!place) {
    throw bad_config(where, "is \"" + config.bus.listen + "\"",
                     "a numeric address and a port, 127.0.0.1:1502; port 0: any free one");
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(place->port));
  inet_pton(AF_INET, place->host.c_str(), &address.sin_addr);
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int yes = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  if (bind(listener_, generic, size) != 0 || ::listen(listener_, kMostClients) != 0) {
    throw bad_config(where, "is \"" + config.bus.listen + "\": " + std::strerror(errno),
                     "a free port of this machine");
  }
  getsockname(listener_, generic, &size);
  address_ = place->host + ":" + std::to_string(ntohs(address.sin_port));
  tcp_.reset(modbus_new_tcp(place->host.c_str(), ntohs(address.sin_port)));
  bound_waits(tcp_.get());
}

void Server::open_serial(const RigConfig& config) {
  const char parity = config.bus.parity == "none" ? 'N' : config.bus.parity == "odd" ? 'O' : 'E';
  serial_.reset(
      modbus_new_rtu(config.bus.serial.c_str(), static_cast<int>(config.bus.baud), parity, 8, 1));
  if (serial_ == nullptr ||
      modbus_set_slave(serial_.get(), static_cast<int>(config.bus.unit)) != 0 ||
      modbus_connect(serial_.get()) != 0) {
    throw bad_config(config.file + ": [bus] serial",
                     "is \"" + config.bus.serial + "\": " + modbus_strerror(errno),
                     "a serial line of this machine");
  }
  bound_waits(serial_.get());
}

void Server::accept_client() {
  const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
  if (client < 0) return;
  if (static_cast<int>(clients_.size()) >= kMostClients) {
    close(client);
    return;
  }
  const int yes = 1;
  setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  clients_.push_back(client);
  ++counts_.clients;
}

void Server::run(const std::function<bool()>& stop, int every_ms) {
  while (!stop()) {
    std::vector<pollfd> files;
    for (const int client : clients_) files.push_back({client, POLLIN, 0});
    if (listener_ >= 0) files.push_back({listener_, POLLIN, 0});
    if (serial_ != nullptr) files.push_back({modbus_get_socket(serial_.get()), POLLIN, 0});
    poll(files.data(), files.size(), every_ms);
    rig_.advance_to(monotonic_ns());
    for (const pollfd& file : files) {
      if (file.revents == 0) continue;
      if (file.fd == listener_) {
        accept_client();
      } else if (serial_ != nullptr && file.fd == modbus_get_socket(serial_.get())) {
        serve(serial_.get());
      } else {
        modbus_set_socket(tcp_.get(), file.fd);
        if (serve(tcp_.get())) continue;
        close(file.fd);
        clients_.erase(std::find(clients_.begin(), clients_.end(), file.fd));
      }
    }
  }
}

bool Server::serve(modbus_t* context) {
  std::uint8_t query[MODBUS_MAX_ADU_LENGTH];
  const int length = modbus_receive(context, query);
  if (length < 0) return false;
  if (length > 0 && !rig_.mute()) answer(context, query, length);
  return true;
}

void Server::answer(modbus_t* context, const std::uint8_t* query, int length) {
  ++counts_.requests;
  rig_.advance_to(monotonic_ns());
  const ModbusRequest request(query + modbus_get_header_length(context));
  const bool of_text = request.address() >= kText;
  refresh();
  const auto written = request.written();
  const bool allowed =
      !written ||
      (of_text ? written->address >= kText && written->address + written->count <= kReply
       : request.of_coils() ? written->address + written->count <= 1
                            : written->address + written->count <= kWritable);
  if (!allowed) {
    ++counts_.refused;
    modbus_reply_exception(context, query, MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
    return;
  }
  // The reply function carries out the writes in its copy of the registers.
  modbus_reply(context, query, length, of_text ? text_.get() : process_.get());
  if (!written) return;
  if (of_text) {
    obey_text();
  } else if (request.of_coils()) {
    rig_.permit(process_->tab_bits[0] != 0);
  } else {
    apply({written->address, written->count});
  }
}

void Server::refresh() {
  std::uint16_t* r = process_->tab_registers;
  const double position_m = rig_.read_position_m();
  const double asked_mV = std::clamp(std::round(rig_.asked_V() * 1e3), -32768.0, 32767.0);
  r[kCommandMillivolts] = static_cast<std::uint16_t>(static_cast<std::int16_t>(asked_mV));
  r[kTimeout] =
      static_cast<std::uint16_t>(std::clamp(std::round(rig_.timeout_s() * 1e3), 0.0, 65535.0));
  put_float(r, kCommand, rig_.asked_V());
  put_float(r, kPosition, position_m);
  put_wide(r, kCounts, static_cast<std::uint32_t>(rig_.counts(position_m)));
  put_float(r, kValve, rig_.converter_V());
  r[kStatus] = rig_.status();
  r[kEStop] = rig_.e_stop_released() ? 1 : 0;
  r[kEnable] = rig_.enabled() ? 1 : 0;
  put_wide(r, kTime, rig_.time_us());
  for (std::size_t i = 0; i < plant_sim::kTransducers.size(); ++i) {
    r[kPressures + i] = kilopascals(rig_.read_pressure_Pa(i));
  }
  std::copy(r, r + kRegisters, process_->tab_input_registers);
  process_->tab_input_bits[0] = rig_.e_stop_released() ? 1 : 0;
  process_->tab_input_bits[1] = rig_.enabled() ? 1 : 0;
}

void Server::apply(const Written& written) {
  const std::uint16_t* r = process_->tab_registers;
  const auto covers = [&](int address) {
    return address >= written.address && address < written.address + written.count;
  };
  if (covers(kTimeout)) rig_.set_timeout(r[kTimeout] * 1e-3);
  if (covers(kCommand) || covers(kCommand + 1)) {
    const std::uint32_t bits = static_cast<std::uint32_t>(r[kCommand]) << 16U | r[kCommand + 1];
    rig_.command(static_cast<double>(std::bit_cast<float>(bits)));
  } else if (covers(kCommandMillivolts)) {
    rig_.command(static_cast<std::int16_t>(r[kCommandMillivolts]) * 1e-3);
  }
}

void Server::obey_text() {
  const std::string reply = rig_.set(text_of(text_->tab_registers, kTextRegisters));
  put_text(reply, text_->tab_registers + kTextRegisters, kTextRegisters);
}

std::string set_remotely(const std::string& address, const std::string& text) {
  const auto failed = [&](const std::string& what) {
    return config::schema::RunError("--address: " + address + ": " + what);
  };
  const auto place = split_address(address);
  if (!place) throw failed("is not a numeric address and port, 127.0.0.1:1502");
  modbus_t* context = modbus_new_tcp(place->host.c_str(), place->port);
  modbus_set_response_timeout(context, 1, 0);
  std::uint16_t registers[kTextRegisters];
  put_text(text, registers, kTextRegisters);
  const bool done = modbus_connect(context) == 0 &&
                    modbus_write_registers(context, kText, kTextRegisters, registers) >= 0 &&
                    modbus_read_registers(context, kReply, kTextRegisters, registers) >= 0;
  const int error = errno;
  modbus_close(context);
  modbus_free(context);
  if (!done) throw failed(modbus_strerror(error));
  return text_of(registers, kTextRegisters);
}

}  // namespace hal::hil_rig
