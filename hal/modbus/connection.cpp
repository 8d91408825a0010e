#include "hal/modbus/connection.h"

#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <ctime>

#include "config/schema/error.h"
#include "hal/monotonic.h"

namespace hal::modbus {
namespace {

constexpr std::size_t kTcpHeader = 7;  ///< transaction, protocol, length, unit
constexpr std::size_t kCrc = 2;
/// Requests are numbered below; the frame that a crash handler sends has this one.
constexpr unsigned kNoTransaction = 0xFFFF;

/// CRC-16 of the serial line protocol: polynomial 0xA001, reflected, low byte first.
unsigned crc_of(const std::uint8_t* bytes, std::size_t size) noexcept {
  unsigned crc = 0xFFFF;
  for (std::size_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U;
  }
  return crc;
}

unsigned word_at(const std::uint8_t* bytes) noexcept {
  return static_cast<unsigned>(bytes[0]) << 8U | bytes[1];
}

void put_word(std::uint8_t* bytes, unsigned word) noexcept {
  bytes[0] = static_cast<std::uint8_t>(word >> 8U);
  bytes[1] = static_cast<std::uint8_t>(word);
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
  modbus_set_error_recovery(context_, MODBUS_ERROR_RECOVERY_NONE);
}

Connection::~Connection() {
  close();
  modbus_free(context_);
}

void Connection::set_timeout(double timeout_s) noexcept {
  timeout_ns_ = std::llround(timeout_s * 1e9);
}

bool Connection::connect() noexcept {
  close();
  const auto us = static_cast<std::uint32_t>(std::lround(config_.connect_timeout_s * 1e6));
  modbus_set_response_timeout(context_, us / 1'000'000U, us % 1'000'000U);
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

std::size_t Connection::frame_size(const Pdu& pdu) const noexcept {
  return pdu.size() + (config_.host.empty() ? 1 + kCrc : kTcpHeader);
}

void Connection::put_frame(const Pdu& pdu, unsigned transaction,
                           std::uint8_t* bytes) const noexcept {
  std::uint8_t* body = bytes;
  if (!config_.host.empty()) {
    put_word(bytes, transaction);
    put_word(bytes + 2, 0);  // protocol
    put_word(bytes + 4, static_cast<unsigned>(pdu.size() + 1));
    body = bytes + kTcpHeader - 1;
  }
  body[0] = static_cast<std::uint8_t>(config_.unit);
  std::copy_n(pdu.data(), pdu.size(), body + 1);
  if (!config_.host.empty()) return;
  const unsigned crc = crc_of(body, 1 + pdu.size());
  body[1 + pdu.size()] = static_cast<std::uint8_t>(crc);
  body[2 + pdu.size()] = static_cast<std::uint8_t>(crc >> 8U);
}

int Connection::receive(std::uint8_t* bytes, std::size_t from, std::size_t to,
                        std::int64_t until_ns) noexcept {
  const int file = modbus_get_socket(context_);
  while (from < to) {
    const std::int64_t left_ns = until_ns - monotonic_ns();
    if (left_ns <= 0) return ETIMEDOUT;
    const timespec left{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
    pollfd waiting{file, POLLIN, 0};
    const int ready = ppoll(&waiting, 1, &left, nullptr);
    if (ready < 0 && errno != EINTR) return errno;
    if (ready <= 0) continue;
    const ssize_t n = ::read(file, bytes + from, to - from);
    if (n == 0) return ECONNRESET;
    if (n < 0 && errno != EINTR && errno != EAGAIN) return errno;
    if (n > 0) from += static_cast<std::size_t>(n);
  }
  return 0;
}

int Connection::receive_tcp(const Pdu& request, Pdu& reply, std::int64_t until_ns) noexcept {
  std::uint8_t header[kTcpHeader];
  if (const int error = receive(header, 0, kTcpHeader, until_ns); error != 0) return error;
  const std::size_t length = word_at(header + 4);  // unit and PDU
  if (word_at(header) != transaction_ || word_at(header + 2) != 0) return EMBBADDATA;
  if (header[6] != config_.unit) return EMBBADSLAVE;
  if (length != 3 && length != 1 + reply_size(request)) return EMBBADDATA;
  reply.resize(length - 1);
  return receive(reply.data(), 0, reply.size(), until_ns);
}

int Connection::receive_rtu(const Pdu& request, Pdu& reply, std::int64_t until_ns) noexcept {
  constexpr std::size_t kShortest = 1 + 2 + kCrc;  // an exception
  std::uint8_t bytes[1 + Pdu::kMost + kCrc];
  if (const int error = receive(bytes, 0, kShortest, until_ns); error != 0) return error;
  if (bytes[0] != config_.unit) return EMBBADSLAVE;
  const bool exception = (bytes[1] & 0x80U) != 0;
  const std::size_t size = exception ? 2 : reply_size(request);
  const std::size_t end = 1 + size;
  if (const int error = receive(bytes, kShortest, end + kCrc, until_ns); error != 0) return error;
  const unsigned crc = crc_of(bytes, end);
  if (bytes[end] != (crc & 0xFFU) || bytes[end + 1] != crc >> 8U) return EMBBADCRC;
  reply.resize(size);
  std::copy_n(bytes + 1, size, reply.data());
  return 0;
}

RequestResult Connection::transact(const Pdu& request, Pdu& reply) noexcept {
  if (!in_step()) return lose(errno);
  const std::int64_t start_ns = monotonic_ns();
  transaction_ = (transaction_ + 1) % kNoTransaction;
  std::uint8_t bytes[kTcpHeader + Pdu::kMost];
  put_frame(request, transaction_, bytes);
  if (!send_bytes(bytes, frame_size(request))) return lose(ECONNRESET);
  const std::int64_t until_ns = start_ns + timeout_ns_;
  int error = config_.host.empty() ? receive_rtu(request, reply, until_ns)
                                   : receive_tcp(request, reply, until_ns);
  if (error == 0) error = check_reply(request, reply);
  if (error != 0 && !(error >= EMBXILFUN && error <= EMBXGTAR)) return lose(error);
  counters_.round_trips.add(monotonic_ns() - start_ns);
  counters_.transactions.fetch_add(1, std::memory_order_relaxed);
  if (error == 0) return RequestResult::done;
  error_ = error;
  counters_.last_error.store(error, std::memory_order_relaxed);
  counters_.exceptions.fetch_add(1, std::memory_order_relaxed);
  return RequestResult::exception;
}

RequestResult Connection::read(const Block& block, std::uint16_t* words) noexcept {
  Pdu reply;
  const RequestResult result = transact(read_request(block), reply);
  if (result == RequestResult::done) unpack(block, reply, words);
  return result;
}

RequestResult Connection::write(const WriteChannel& channel, Bits bits) noexcept {
  Pdu reply;
  return transact(write_request(channel, bits, config_.multiple_only), reply);
}

RequestResult Connection::exchange(const WriteChannel& channel, Bits bits, const Block& block,
                                   std::uint16_t* words) noexcept {
  Pdu reply;
  const RequestResult result = transact(exchange_request(channel, bits, block), reply);
  if (result == RequestResult::done) unpack(block, reply, words);
  return result;
}

std::vector<std::uint8_t> Connection::frame(const WriteChannel& channel, Bits bits) const {
  const Pdu pdu = write_request(channel, bits, config_.multiple_only);
  std::vector<std::uint8_t> bytes(frame_size(pdu));
  put_frame(pdu, kNoTransaction, bytes.data());
  return bytes;
}

bool Connection::send_bytes(const std::uint8_t* bytes, std::size_t size) const noexcept {
  const int file = file_.load();
  if (file < 0) return false;
  const ssize_t sent = config_.host.empty() ? ::write(file, bytes, size)
                                            : send(file, bytes, size, MSG_DONTWAIT | MSG_NOSIGNAL);
  return sent == static_cast<ssize_t>(size);
}

bool Connection::send_now(const std::vector<std::uint8_t>& frame) const noexcept {
  return send_bytes(frame.data(), frame.size());
}

}  // namespace hal::modbus
