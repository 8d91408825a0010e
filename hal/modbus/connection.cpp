#include "hal/modbus/connection.h"

#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>

#include "config/schema/error.h"
#include "hal/monotonic.h"

namespace hal::modbus {
namespace {

void append_word(std::vector<std::uint8_t>& bytes, unsigned word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(word));
}

/// CRC-16 of the serial line protocol: polynomial 0xA001, reflected, low byte first.
void append_crc(std::vector<std::uint8_t>& bytes) {
  unsigned crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U;
  }
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
}

}  // namespace

Connection::Connection(const ConnectionConfig& config, Counters& counters)
    : config_(config),
      counters_(counters),
      context_(config.host.empty() ? modbus_new_rtu(config.serial.c_str(), config.baud,
                                                    config.parity, 8, config.stop_bits)
                                   : modbus_new_tcp(config.host.c_str(), config.port)) {
  if (context_ == nullptr || modbus_set_slave(context_, config.unit) != 0) {
    modbus_free(context_);
    throw config::schema::bad_config(
        "[modbus] " + std::string(config.host.empty() ? "serial" : "address"),
        "is not a usable address or serial line", "127.0.0.1:502, /dev/ttyS0");
  }
  // The library's own recovery retries for ever: off. One time-out for the whole reply, not per
  // byte.
  modbus_set_error_recovery(context_, MODBUS_ERROR_RECOVERY_NONE);
  modbus_set_byte_timeout(context_, 0, 0);
}

Connection::~Connection() {
  close();
  modbus_free(context_);
}

void Connection::set_timeout(double timeout_s) noexcept {
  const auto us = static_cast<std::uint32_t>(std::lround(timeout_s * 1e6));
  modbus_set_response_timeout(context_, us / 1'000'000U, us % 1'000'000U);
}

bool Connection::connect() noexcept {
  close();
  set_timeout(config_.connect_timeout_s);
  if (modbus_connect(context_) != 0) {
    error_ = errno;
    counters_.last_error.store(error_, std::memory_order_relaxed);
    return false;
  }
  const int file = modbus_get_socket(context_);
  if (!config_.host.empty()) {
    // Bytes that a closed connection has not delivered must never arrive.
    const linger none{1, 0};
    setsockopt(file, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  } else {
    if (flock(file, LOCK_EX | LOCK_NB) != 0) {  // another program talks on this line
      error_ = EBUSY;
      counters_.last_error.store(error_, std::memory_order_relaxed);
      modbus_close(context_);
      return false;
    }
    modbus_flush(context_);
  }
  file_.store(file);
  open_ = true;
  set_timeout(config_.timeout_s);
  return true;
}

void Connection::close() noexcept {
  if (!open_) return;
  file_.store(-1);
  if (config_.host.empty()) {
    modbus_close(context_);
  } else {
    // modbus_close() would end the connection in order, delivering what is left, before it closes.
    ::close(modbus_get_socket(context_));
    modbus_set_socket(context_, -1);
  }
  open_ = false;
}

bool Connection::in_step() noexcept {
  if (config_.host.empty()) {
    modbus_flush(context_);  // noise on the line between two requests
    return true;
  }
  std::uint8_t byte = 0;
  const ssize_t waiting = recv(modbus_get_socket(context_), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  if (waiting < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return true;
  if (waiting > 0) errno = EMBMDATA;
  if (waiting == 0) errno = ECONNRESET;
  return false;
}

RequestResult Connection::lose(int error) noexcept {
  error_ = error;
  counters_.last_error.store(error, std::memory_order_relaxed);
  Counters::Count& count = error == ETIMEDOUT       ? counters_.timeouts
                           : error > MODBUS_ENOBASE ? counters_.bad_replies
                                                    : counters_.link_errors;
  count.fetch_add(1, std::memory_order_relaxed);
  close();
  return RequestResult::lost;
}

RequestResult Connection::judge(int result, std::int64_t start_ns) noexcept {
  const int error = errno;
  if (result < 0 && !(error >= EMBXILFUN && error <= EMBXGTAR)) return lose(error);
  counters_.round_trips.add(monotonic_ns() - start_ns);
  counters_.transactions.fetch_add(1, std::memory_order_relaxed);
  if (result >= 0) return RequestResult::done;
  error_ = error;
  counters_.last_error.store(error, std::memory_order_relaxed);
  counters_.exceptions.fetch_add(1, std::memory_order_relaxed);
  return RequestResult::exception;
}

RequestResult Connection::read(const Block& block, std::uint16_t* words) noexcept {
  if (!in_step()) return lose(errno);
  const std::int64_t start_ns = monotonic_ns();
  if (block.table == RegisterTable::holding) {
    return judge(modbus_read_registers(context_, block.address, block.count, words), start_ns);
  }
  if (block.table == RegisterTable::input) {
    return judge(modbus_read_input_registers(context_, block.address, block.count, words),
                 start_ns);
  }
  std::array<std::uint8_t, kMostBits> bits;
  const auto read_bits =
      block.table == RegisterTable::coil ? modbus_read_bits : modbus_read_input_bits;
  const RequestResult outcome =
      judge(read_bits(context_, block.address, block.count, bits.data()), start_ns);
  for (int i = 0; outcome == RequestResult::done && i < block.count; ++i) words[i] = bits[i];
  return outcome;
}

RequestResult Connection::write(const WriteChannel& channel, Bits bits) noexcept {
  if (!in_step()) return lose(errno);
  const std::int64_t start_ns = monotonic_ns();
  if (channel.table == RegisterTable::coil) {
    return judge(modbus_write_bit(context_, channel.address, bits != 0 ? 1 : 0), start_ns);
  }
  std::uint16_t words[2];
  channel.codec.store(bits, words);
  const int count = channel.codec.words();
  if (count == 1 && !config_.multiple_only) {
    return judge(modbus_write_register(context_, channel.address, words[0]), start_ns);
  }
  return judge(modbus_write_registers(context_, channel.address, count, words), start_ns);
}

RequestResult Connection::exchange(const WriteChannel& channel, Bits bits, const Block& block,
                                   std::uint16_t* words) noexcept {
  if (!in_step()) return lose(errno);
  const std::int64_t start_ns = monotonic_ns();
  std::uint16_t written[2];
  channel.codec.store(bits, written);
  return judge(modbus_write_and_read_registers(context_, channel.address, channel.codec.words(),
                                               written, block.address, block.count, words),
               start_ns);
}

std::vector<std::uint8_t> Connection::frame(const WriteChannel& channel, Bits bits) const {
  std::uint16_t words[2];
  channel.codec.store(bits, words);
  const auto count = static_cast<unsigned>(channel.codec.words());
  std::vector<std::uint8_t> body{static_cast<std::uint8_t>(config_.unit)};
  const bool single = count == 1 && !config_.multiple_only;
  body.push_back(single ? 6 : 16);
  append_word(body, static_cast<unsigned>(channel.address));
  if (!single) {
    append_word(body, count);
    body.push_back(static_cast<std::uint8_t>(2 * count));
  }
  for (unsigned i = 0; i < count; ++i) append_word(body, words[i]);
  if (config_.host.empty()) {
    append_crc(body);
    return body;
  }
  std::vector<std::uint8_t> bytes;
  append_word(bytes, 0xFFFF);  // transaction
  append_word(bytes, 0);       // protocol
  append_word(bytes, static_cast<unsigned>(body.size()));
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

bool Connection::send_now(const std::vector<std::uint8_t>& frame) const noexcept {
  const int file = file_.load();
  if (file < 0) return false;
  const ssize_t sent = config_.host.empty()
                           ? ::write(file, frame.data(), frame.size())
                           : send(file, frame.data(), frame.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(frame.size());
}

}  // namespace hal::modbus
