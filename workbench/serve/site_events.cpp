// Pages learn unasked: the session's state, the progress of jobs, and the daemon's alarms.
#include <chrono>
#include <iostream>

#include "workbench/control/answer_text.h"
#include "workbench/control/order.h"
#include "workbench/present/json.h"
#include "workbench/present/text.h"
#include "workbench/serve/site.h"

namespace workbench::serve {
namespace {

using Json = nlohmann::ordered_json;
namespace protocol = monitor::control;

constexpr std::chrono::milliseconds kProgressPeriod{100};

}  // namespace

Jobs::Progress Site::progress() {
  using Clock = std::chrono::steady_clock;
  return [this, told = Clock::time_point{}](const std::string& text, int done, int of) mutable {
    if (Clock::now() - told < kProgressPeriod) return;
    told = Clock::now();
    publish(kWorkbenchTopic, "progress", {{"text", text}, {"done", done}, {"of", of}});
  };
}

Site::Json Site::whole_state() {
  Json state = study_.state();
  state["folder"] = folder_.name();
  state["trouble"] = trouble_;
  state["running"] = jobs_.running();
  state["result"] = last_result_;
  state["change"] = gate_.change_secret();
  state["orders"] = options_.allow_orders;
  return state;
}

void Site::publish_state() {
  try {
    Json state = whole_state();
    state.erase("change");
    publish(kWorkbenchTopic, "state", state);
    watch_model();
  } catch (const std::exception& error) {
    // Whatever was done is done: a page learns of it with the next event.
    std::cerr << "spoolwatch serve: the state is not shown: " << error.what() << '\n';
  }
}

void Site::watch_model() {
  const std::string& model = study_.live_model();
  if (model == live_model_) return;
  live_model_ = model;
  live_.watch_model(folder_.path_of(model));
}

void Site::publish(unsigned topic, const char* name, const Json& data) {
  if (HttpServer* const server = server_) {
    server->publish(topic, event_text(name, data.dump(-1, ' ', false,
                                                      nlohmann::json::error_handler_t::replace)));
  }
}

void Site::on_stream_open(StreamId stream, unsigned topics) {
  ++watching_;
  if ((topics & kLiveTopic) != 0) live_.open(stream);
}

void Site::on_stream_closed(StreamId stream, unsigned topics) {
  --watching_;
  if ((topics & kLiveTopic) != 0) live_.close(stream);
}

void Site::poll_control() {
  if (control_lane_.waiting() > 0) return;
  control_lane_.post([this] {
    Json out;
    try {
      out = control::ask_daemon(options_.control_socket,
                                {{protocol::key::kCommand, protocol::kAlarms}});
      out["control"] = "";
      out["detectable"] = Json::array();
      const Json status = control::ask_daemon(options_.control_socket,
                                              {{protocol::key::kCommand, protocol::kStatus}});
      for (const control::DetectableLines& source : control::detectable_lines(status)) {
        out["detectable"].push_back({{"smallest", present::typeset(source.smallest)},
                                     {"more", present::typeset_all(source.more)}});
      }
    } catch (const std::exception& error) {
      out["control"] = error.what();
    }
    publish(kLiveTopic, "alarms", out);
  });
}

}  // namespace workbench::serve
