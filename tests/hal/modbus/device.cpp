#include "tests/hal/modbus/device.h"

#include <arpa/inet.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

namespace hal::modbus {
namespace {

using Bytes = std::vector<std::uint8_t>;

int word(const Bytes& b, std::size_t at) { return b.at(at) << 8 | b.at(at + 1); }

/// CRC-16 of the serial protocol, bit by bit as its text describes it.
int crc_of(const Bytes& bytes, std::size_t count) {
  unsigned crc = 0xFFFF;
  for (std::size_t i = 0; i < count; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) {
      const bool carry = (crc & 1U) != 0;
      crc >>= 1U;
      if (carry) crc ^= 0xA001U;
    }
  }
  return static_cast<int>(crc);
}

/// Length of an RTU request after the unit's number, without CRC; 0: more bytes are needed.
std::size_t request_length(const Bytes& b) {
  if (b.size() < 2) return 0;
  if (b[1] == 16) return b.size() < 7 ? 0 : 6U + b[6];
  if (b[1] == 23) return b.size() < 11 ? 0 : 10U + b[10];
  return 5;
}

void sleep_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

void close_with_reset(int file) {
  const linger now{1, 0};
  setsockopt(file, SOL_SOCKET, SO_LINGER, &now, sizeof now);
  close(file);
}

}  // namespace

Device::Device(Line line) : line_(line) {
  if (line == Line::tcp) {
    listen();
  } else {
    char name[128];
    openpty(&pty_, &pty_client_, name, nullptr, nullptr);
    termios raw{};
    tcgetattr(pty_client_, &raw);
    cfmakeraw(&raw);
    tcsetattr(pty_client_, TCSANOW, &raw);
    serial_ = name;
    clients_.push_back({pty_, 1, {}});
    connections_.store(1);
  }
  thread_ = std::thread([this] { run(); });
}

Device::~Device() {
  stop_.store(true);
  thread_.join();
  for (const Client& client : clients_) close(client.file);
  if (listener_ >= 0) close(listener_);
  if (pty_client_ >= 0) close(pty_client_);
}

void Device::listen() {
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port_));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  if (bind(file, generic, size) != 0 || ::listen(file, 8) != 0) {
    perror("device: listen");
    std::abort();
  }
  getsockname(file, generic, &size);
  port_ = ntohs(address.sin_port);
  listener_ = file;
}

void Device::set(int address, std::uint16_t value) {
  const std::lock_guard lock(mutex_);
  registers_.at(static_cast<std::size_t>(address)) = value;
}

std::uint16_t Device::get(int address) {
  const std::lock_guard lock(mutex_);
  return registers_.at(static_cast<std::size_t>(address));
}

void Device::answer(Reply reply, int count) {
  const std::lock_guard lock(mutex_);
  reply_ = reply;
  count_ = count;
}

void Device::close_all(bool reset) {
  const std::lock_guard lock(mutex_);
  for (const Client& client : clients_)
    reset ? close_with_reset(client.file) : (void)close(client.file);
  clients_.clear();
}

void Device::unplug() {
  unplugged_.store(true);
  sleep_ms(20);  // the thread has seen it
  close(listener_);
  listener_ = -1;
}

void Device::plug_in() {
  close_all(true);
  listen();
  unplugged_.store(false);
}

void Device::reboot(int off_ms) {
  unplug();
  sleep_ms(off_ms);
  {
    const std::lock_guard lock(mutex_);
    registers_.fill(0);
  }
  plug_in();
}

void Device::half_open(bool on) { deaf_.store(on); }

std::vector<Received> Device::received() {
  const std::lock_guard lock(mutex_);
  return received_;
}

std::vector<Received> Device::writes(int connection) {
  std::vector<Received> found;
  for (const Received& r : received()) {
    if (!r.words.empty() && (connection == 0 || r.connection == connection)) found.push_back(r);
  }
  return found;
}

void Device::run() {
  while (!stop_.load()) {
    if (unplugged_.load()) {
      sleep_ms(1);
      continue;
    }
    std::vector<pollfd> files;
    {
      const std::lock_guard lock(mutex_);
      for (const Client& client : clients_) files.push_back({client.file, POLLIN, 0});
    }
    if (deaf_.load()) files.clear();
    if (listener_ >= 0) files.push_back({listener_, POLLIN, 0});
    poll(files.data(), files.size(), 2);
    if (unplugged_.load()) continue;
    for (const pollfd& file : files) {
      if (file.revents == 0) continue;
      if (file.fd == listener_) {
        const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        const std::lock_guard lock(mutex_);
        if (client >= 0) clients_.push_back({client, ++connections_, {}});
        continue;
      }
      const auto client = std::find_if(clients_.begin(), clients_.end(),
                                       [&](const Client& c) { return c.file == file.fd; });
      if (client != clients_.end() && !read_from(*client)) {
        const std::lock_guard lock(mutex_);
        close(client->file);
        clients_.erase(client);
      }
    }
  }
}

bool Device::read_from(Client& client) {
  std::uint8_t bytes[512];
  const ssize_t count = read(client.file, bytes, sizeof bytes);
  if (count <= 0) return count < 0 && line_ == Line::rtu && errno == EIO;
  client.bytes.insert(client.bytes.end(), bytes, bytes + count);
  take_frames(client);
  return client.file >= 0;
}

void Device::take_frames(Client& client) {
  Bytes& b = client.bytes;
  for (;;) {
    if (line_ == Line::tcp) {
      if (b.size() < 8 || b.size() < 6U + static_cast<std::size_t>(word(b, 4))) return;
      const auto end = b.begin() + 6 + word(b, 4);
      const Bytes head(b.begin(), b.begin() + 7);
      const Bytes request(b.begin() + 7, end);
      b.erase(b.begin(), end);
      serve(client, head, request);
    } else {
      const std::size_t length = request_length(b);
      if (length == 0 || b.size() < 1 + length + 2) return;
      const Bytes frame(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(length) + 3);
      b.erase(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(length) + 3);
      const int crc = frame[length + 1] | frame[length + 2] << 8;
      if (crc != crc_of(frame, length + 1)) {
        b.clear();  // another speed or parity: nothing is understood
        return;
      }
      serve(client, {frame[0]}, Bytes(frame.begin() + 1, frame.end() - 2));
    }
  }
}

Reply Device::next_reply(int function) {
  const std::lock_guard lock(mutex_);
  const int only = only_function_.load();
  if (only != 0 && only != function) return Reply::normal;
  const Reply reply = reply_;
  if (count_ > 0 && --count_ == 0) reply_ = Reply::normal;
  return reply;
}

void Device::serve(const Client& client, const Bytes& head, const Bytes& request) {
  const Reply how = next_reply(request[0]);
  Bytes pdu = carry_out(request, client.number);
  if (how == Reply::busy) pdu = {static_cast<std::uint8_t>(request[0] | 0x80), 6};
  if (how == Reply::garbled) pdu[0] = static_cast<std::uint8_t>(pdu[0] ^ 0x15);
  if (how == Reply::wrong_echo && (pdu[0] == 6 || pdu[0] == 16)) ++pdu[2];
  Bytes reply = head;
  if (how == Reply::wrong_unit) ++reply[line_ == Line::tcp ? 6 : 0];
  if (line_ == Line::tcp) {
    if (how == Reply::wrong_transaction) reply[1] = static_cast<std::uint8_t>(reply[1] + 7);
    reply[4] = static_cast<std::uint8_t>((pdu.size() + 1) >> 8);
    reply[5] = static_cast<std::uint8_t>(how == Reply::no_length ? 0 : pdu.size() + 1);
  } else if (how == Reply::wrong_transaction) {
    reply[0] = static_cast<std::uint8_t>(reply[0] + 1);
  }
  reply.insert(reply.end(), pdu.begin(), pdu.end());
  if (line_ == Line::rtu) {
    const int crc = crc_of(reply, reply.size()) ^ (how == Reply::wrong_check ? 0x100 : 0);
    reply.push_back(static_cast<std::uint8_t>(crc));
    reply.push_back(static_cast<std::uint8_t>(crc >> 8));
  }
  if (how == Reply::truncated) reply.pop_back();
  if (how == Reply::doubled) {
    const Bytes once = reply;
    reply.insert(reply.end(), once.begin(), once.end());
  }
  if (how == Reply::slow) sleep_ms(static_cast<int>(0.85e3 * kReplyTimeout_s));
  if (how == Reply::late) sleep_ms(static_cast<int>(2e3 * kReplyTimeout_s));
  if (how == Reply::lost) return;
  if (how == Reply::close) {
    shutdown(client.file, SHUT_RDWR);
    return;
  }
  const ssize_t sent = line_ == Line::tcp
                           ? send(client.file, reply.data(), reply.size(), MSG_NOSIGNAL)
                           : write(client.file, reply.data(), reply.size());
  (void)sent;  // the client may be gone
}

}  // namespace hal::modbus
