// The control socket: a Unix stream socket for queries and commands, one line each way at a time
// (control/protocol.h). Anyone who can connect may query; the daemon's user, root and members of
// `act_group` (default: `group`) may command. The kernel identifies the peers (SO_PEERCRED,
// SO_PEERGROUPS).
//
// One thread. Only wait() blocks, up to its timeout.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

#include "config/schema/visitor.h"

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
  };

  /// Replaces a stale socket; throws config::schema::RunError when another process serves the
  /// socket or it cannot be created. `file`: for messages.
  ControlSocket(const ControlConfig& config, const std::string& file);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Waits for input here or on the file descriptor `other`, up to the timeout.
  void wait(int timeout_ms, int other);
  /// The oldest pending request; a client's next line waits until this one is answered.
  bool next(Request& request);
  /// `line` without newline. Ignored when the client has disconnected.
  void answer(std::uint64_t client, const std::string& line);

 private:
  struct Client {
    std::uint64_t id;
    int file;
    bool may_act;
    unsigned uid;
    bool asking = false;  ///< a request is unanswered
    std::string in;
    std::string out;
    bool gone = false;
  };
  void accept_clients();
  void read(Client& client);
  void write(Client& client);
  void drop_gone();

  std::filesystem::path path_;
  gid_t group_;
  gid_t act_group_;
  int lock_ = -1;
  int listener_ = -1;
  std::uint64_t next_id_ = 1;
  std::vector<Client> clients_;
};

}  // namespace monitor::io
