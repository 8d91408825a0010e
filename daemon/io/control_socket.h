// The control socket: a Unix stream socket on which other programs ask and order, one line each way
// at a time (control/protocol.h). Anyone who can connect may look; the same user, root and members
// of `act_group` (where there is none, of `group`) may act, as the kernel says who they are
// (SO_PEERCRED, SO_PEERGROUPS).
//
// One thread. Nothing here blocks but wait(), and that only as long as it is told to.
#pragma once

#include <cstdint>
#include <deque>
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
  std::string group;          ///< of the socket, whose members may connect, as `mode` says
  std::string act_group;      ///< whose members may act; empty: those of `group`

  void visit(config::schema::Visitor& v);
};

/// Throws config::schema::ConfigError for a path too long, a bad mode, a group unknown.
void check_control(const ControlConfig& config, const std::string& file);

class ControlSocket {
 public:
  struct Request {
    std::uint64_t client;  ///< whom to answer
    std::string line;
    bool may_act;
    unsigned uid;
  };

  /// Takes the place of a socket that nobody serves any more; throws config::schema::RunError
  /// when another process serves it, or when it cannot be made. `file`: for messages.
  ControlSocket(const ControlConfig& config, const std::string& file);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Up to that time, or until something comes here or to `other` (a file descriptor).
  void wait(int timeout_ms, int other);
  /// The oldest request not yet taken; a client's next line waits until this one is answered.
  bool next(Request& request);
  /// `line` without its end. A client that has gone is not missed.
  void answer(std::uint64_t client, const std::string& line);

 private:
  struct Client {
    std::uint64_t id;
    int file;
    bool may_act;
    unsigned uid;
    bool asking = false;  ///< a request of it has not been answered
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
