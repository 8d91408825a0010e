// The control socket: a Unix stream socket for queries and commands, one line each way at a time
// (control/protocol.h). Anyone who can connect may query; the daemon's user, root and members of
// `act_group` (default: `group`) may command. The kernel identifies the peers (SO_PEERCRED,
// SO_PEERGROUPS).
//
// Turns: stop and disarm come first, then what else goes to the loop, then further requests of
// those who may command, then of those who may only query; among equals the client that was served
// longest ago. Each user who may only query has a rate, and such users share connections of their
// own, so that none of them can keep a command from being served.
//
// One thread. Only wait() blocks, up to its timeout.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/io/control_messages.h"

namespace monitor::io {

/// TOML [control].
struct ControlConfig {
  std::string socket;         ///< path; empty: no socket
  std::string mode = "0660";  ///< permissions of the socket, octal
  std::string group;          ///< group of the socket; its members may connect as `mode` allows
  std::string act_group;      ///< its members may command; empty: members of `group`

  void visit(config::schema::Visitor& v);
};

/// Throws config::schema::ConfigError for a too long path, a bad mode or an unknown group.
void check_control(const ControlConfig& config, const std::string& file);

class ControlSocket {
 public:
  struct Request {
    std::uint64_t client;  ///< recipient of the answer
    std::string line;
    bool may_act;
    unsigned uid;
    ControlRequest content;  ///< the line, parsed
  };
  using Accepts = std::function<bool(const ControlRequest&)>;

  /// Replaces a stale socket; throws config::schema::RunError when another process serves the
  /// socket or it cannot be created. `file`: for messages.
  ControlSocket(const ControlConfig& config, const std::string& file);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Waits for input here or on the file descriptor `other`, up to the timeout.
  void wait(int timeout_ms, int other);
  /// The first request in turn of those that `accepts` allows (empty: all); a client's next line
  /// waits until this one is answered.
  bool next(Request& request, const Accepts& accepts = {});
  /// `line` without newline. Ignored when the client has disconnected.
  void answer(std::uint64_t client, const std::string& line);

 private:
  struct Client {
    std::uint64_t id;
    int file;
    bool may_act;
    unsigned uid;
    std::int64_t owner;          ///< the process of one who may act, the user of one who may not
    bool asking = false;         ///< a request is unanswered
    std::uint64_t heard = 0;     ///< turn in which the client last sent something
    std::uint64_t served = 0;    ///< turn in which a request of the client was last returned
    std::uint64_t requests = 0;  ///< returned so far
    std::optional<ControlRequest> head;  ///< the first line of `in`
    std::string in;
    std::string out;
    bool gone = false;
  };
  /// Requests that a user who may only query still has.
  struct Allowance {
    double requests;
    std::int64_t since_ns;
  };
  /// First the most urgent.
  enum class Urgency : std::uint8_t { stop, loop, act, look };

  /// Parses the first whole line of what the client sent.
  static void find_head(Client& client);
  void accept_clients();
  /// False when no client of that kind can make room.
  bool make_room(bool may_act);
  static Urgency urgency_of(const Client& client) noexcept;
  /// Time until the user may query again.
  double wait_s(unsigned uid);
  void read(Client& client);
  void write(Client& client);
  void drop_gone();

  std::filesystem::path path_;
  gid_t group_;
  gid_t act_group_;
  int lock_ = -1;
  int listener_ = -1;
  std::uint64_t next_id_ = 1;
  std::uint64_t turn_ = 0;
  std::vector<Client> clients_;
  std::map<unsigned, Allowance> allowances_;  ///< by uid
};

}  // namespace monitor::io
