// spoolwatch serve: the workbench and the live stand as a page for a browser on this machine.
#include "workbench/serve/serve.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "config/messages/channels.h"
#include "config/schema/error.h"
#include "daemon/control/protocol.h"
#include "workbench/cli/command.h"
#include "workbench/cli/interrupt.h"
#include "workbench/cli/order_options.h"
#include "workbench/serve/page_files.h"

namespace workbench::cli {
namespace {

constexpr int kMostPort = 65535;

void serve_page(serve::ServeOptions options) {
  if (const std::string missing = serve::missing_page_files(); !missing.empty()) {
    throw config::schema::RunError(missing);
  }
  if (!options.socket.empty()) options.socket = std::filesystem::absolute(options.socket).string();
  if (!options.control_socket.empty()) {
    options.control_socket = std::filesystem::absolute(options.control_socket).string();
  }
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  std::filesystem::current_path(options.folder, error);
  if (error) {
    throw config::schema::RunError("--folder " + options.folder + ": " + error.message());
  }
  // Files are then named as someone who works in the folder names them.
  const std::string folder = std::filesystem::current_path().string();
  options.folder = ".";
  const StopCondition stop(0.0);
  serve::Serve page(options);
  std::cout << "Open " << page.url() << "\nThe session's files are in " << folder
            << "; Ctrl-C ends it." << std::endl;
  if (page.port() == 0) {
    std::cout << "PORT is that of a tunnel to " << page.path() << ", as ssh -L PORT:" << page.path()
              << " makes one." << std::endl;
  }
  std::thread watch([&] {
    while (!stop.reached()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    page.stop();
  });
  page.run();
  watch.join();
}

}  // namespace

void add_serve(CLI::App& command, int&) {
  auto options = std::make_shared<serve::ServeOptions>();
  options->lcm_url = config::messages::kDefaultUrl;
  options->prefix = config::messages::kDefaultPrefix;
  options->control_socket = monitor::control::kDefaultSocket;
  options->folder = "spoolwatch-session";
  CLI::Option* const port =
      command.add_option("--port", options->port, "port on 127.0.0.1; 0: a free one")
          ->check(CLI::Range(0, kMostPort))
          ->capture_default_str();
  command
      .add_option("--socket", options->socket,
                  "serve on this Unix socket instead, of mode 0600, for ssh -L")
      ->excludes(port);
  command.add_option("--folder", options->folder, "folder of the session's files, made if missing")
      ->capture_default_str();
  command.add_option("--lcm-url", options->lcm_url, "LCM URL of the live page")
      ->capture_default_str();
  command.add_option("--prefix", options->prefix, "prefix of the channel names")
      ->capture_default_str();
  command.add_option("--control", options->control_socket, "control socket of the daemon")
      ->envname("SPOOLWATCH_SOCKET")
      ->capture_default_str();
  command.add_flag(
      "--allow-orders", options->allow_orders,
      "alarms may be acknowledged and shelved from the page; the daemon decides by the "
      "user that runs this command");
  command.callback([options] { serve_page(*options); });
}

}  // namespace workbench::cli
