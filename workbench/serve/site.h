// The paths of the page: what a browser may ask, who may ask it, and which thread answers.
//
//   network  checks, files of the page, hand-over to the lanes below
//   study    everything that reads or changes the session; slider moves, of which the last wins
//   job      one fit or diagnosis
//   live     the daemon's messages; control: its socket
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "workbench/serve/gate.h"
#include "workbench/serve/http_server.h"
#include "workbench/serve/jobs.h"
#include "workbench/serve/lane.h"
#include "workbench/serve/live_channel.h"
#include "workbench/serve/session_folder.h"
#include "workbench/serve/study.h"

namespace workbench::serve {

struct SiteOptions {
  std::filesystem::path folder;
  unsigned short port = 0;  ///< that the page is served on; 0: a Unix socket
  LiveOptions live;
  std::string control_socket;
  bool allow_orders = false;  ///< alarms may be acknowledged and shelved from the page
};

/// Kinds of events, as bits.
inline constexpr unsigned kWorkbenchTopic = 1;
inline constexpr unsigned kLiveTopic = 2;

class Site final : public HttpHandler {
 public:
  /// Throws config::schema::Error when the folder cannot be used.
  explicit Site(const SiteOptions& options);
  ~Site() override;

  /// Where events go; before the server runs, from then on until end().
  void serve_on(HttpServer& server);
  /// Waits for what runs; no event is published afterwards.
  void end();

  BodyPlan admit(const HttpHead& head) override;
  void handle(HttpRequest request, HttpReply reply) override;
  void on_stream_open(StreamId stream, unsigned topics) override;
  void on_stream_closed(StreamId stream, unsigned topics) override;

  [[nodiscard]] const std::string& token() const { return gate_.token(); }

 private:
  using Json = nlohmann::ordered_json;
  void answer_read(const HttpHead& head, const HttpReply& reply);
  void answer_change(const HttpRequest& request, const HttpReply& reply);
  void log_in(const HttpRequest& request, const HttpReply& reply) const;
  void take_upload(const HttpRequest& request, const HttpReply& reply);
  void preview(const Json& body, const HttpReply& reply);
  void order(const Json& body, const HttpReply& reply);
  /// Runs `work` on the study's thread and answers with what it returns, errors included; `changes`
  /// tells all pages.
  void on_study(const HttpReply& reply, std::function<Json()> work, bool changes);
  /// Writes the capture of that `number`, or the newest, as a record; its file name.
  Json save_capture(const Json& body);
  Json begin_fit(const Json& body);
  Json begin_diagnosis(const Json& body);
  /// At most ten events a second.
  Jobs::Progress progress();
  /// On the pages from now on; a diagnosis of all effects stays beside what comes after it.
  void show_result(Json result);
  void finish_job(JobResult result, const std::string& parent, const std::string& output);
  /// Shows the result of a job; its model waits where the folder cannot take it.
  void keep_result(const JobResult& result, const std::string& parent, const std::string& output);
  /// Writes the model of a job, which becomes the trial.
  void take_result(const JobResult& result, const std::string& parent);
  /// Saves the results that had to wait for the folder.
  void take_unsaved();
  /// Stops the running job; its result and those that wait are written or said to be lost.
  void end_jobs();
  /// Whether files can be written; what waits for it is then done. `failed`: something was not
  /// written just now.
  void check_folder(bool failed);
  void watch_folder();
  void publish(unsigned topic, const char* name, const Json& data);
  void publish_state();
  Json whole_state();
  /// The open model runs beside the stand.
  void watch_model();
  void poll_control();

  const SiteOptions options_;
  Gate gate_;
  SessionFolder folder_;
  std::atomic<HttpServer*> server_{nullptr};
  // Of the study's thread:
  Study study_;
  Json last_result_, last_diagnosis_;
  std::string live_model_;
  std::string trouble_;  ///< of the folder; empty: none
  struct Unsaved {
    JobResult result;
    std::string parent;
  };
  std::deque<Unsaved> unsaved_;  ///< results of jobs that could not be written, oldest first
  LiveChannel live_;
  Lane control_lane_;
  Lane study_lane_;
  Jobs jobs_;
  std::atomic<int> watching_{0};  ///< pages
  std::mutex ends_mutex_;
  std::condition_variable ends_soon_;
  bool ends_ = false;
  std::thread folder_watch_;
};

}  // namespace workbench::serve
