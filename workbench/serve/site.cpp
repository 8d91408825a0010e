#include "workbench/serve/site.h"

#include "config/record/record.h"
#include "config/schema/error.h"
#include "workbench/control/order.h"
#include "workbench/model/kinds.h"
#include "workbench/present/json.h"
#include "workbench/serve/page_files.h"
#include "workbench/serve/request_fields.h"

namespace workbench::serve {
namespace {

using config::schema::UsageError;
using Json = nlohmann::ordered_json;
namespace protocol = monitor::control;

constexpr std::string_view kApi = "/api/";
constexpr std::string_view kFiles = "/files/";
constexpr std::string_view kUploads = "/api/upload";
constexpr std::string_view kLogin = "/api/login";
constexpr std::size_t kMostStudyWork = 64;

HttpResponse json_response(const Json& json, int status = 200) {
  return {.status = status,
          .body = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

HttpResponse refusal(int status, const std::string& why) {
  return json_response({{"error", why}}, status);
}

bool starts(const std::string& text, std::string_view with) {
  return std::string_view(text).substr(0, with.size()) == with;
}

/// The answer to a request that ended in an exception.
HttpResponse refusal_of(const std::exception& error) {
  const bool usage = dynamic_cast<const config::schema::Error*>(&error) != nullptr;
  return refusal(usage ? 422 : 500, usage ? error.what() : "the request failed");
}

/// The kinds of models that can be made, with the questions of each.
Json kinds_json() {
  Json out = Json::array();
  for (const model::Kind& kind : model::kinds()) {
    Json questions = Json::array();
    for (const model::Question& q : kind.questions) {
      questions.push_back({{"flag", q.flag},
                           {"what", q.what},
                           {"where", q.where},
                           {"allowed", questions::allowed(q)},
                           {"usual", present::number_or_null(q.usual)}});
    }
    out.push_back({{"name", kind.name}, {"what", kind.what}, {"questions", questions}});
  }
  return out;
}

}  // namespace

Site::Site(const SiteOptions& options)
    : options_(options),
      gate_(options.port),
      folder_(options.folder),
      study_(folder_),
      live_(
          options.live,
          [this](const std::vector<StreamId>& pages, const char* name, const std::string& json) {
            if (HttpServer* const server = server_) {
              server->publish_to(pages, event_text(name, json));
            }
          },
          [this] { poll_control(); }) {
  watch_model();
  folder_watch_ = std::thread([this] { watch_folder(); });
}

Site::~Site() { end(); }

void Site::serve_on(HttpServer& server) { server_ = &server; }

void Site::end() {
  {
    const std::lock_guard lock(ends_mutex_);
    ends_ = true;
  }
  ends_soon_.notify_one();
  if (folder_watch_.joinable()) folder_watch_.join();
  end_jobs();
  live_.end();
  control_lane_.end();
  server_ = nullptr;
}

BodyPlan Site::admit(const HttpHead& head) {
  const auto refuse = [](int status, const std::string& why) {
    return BodyPlan{.kind = BodyPlan::Kind::refuse, .refusal = refusal(status, why)};
  };
  if (const Gate::Verdict here = gate_.from_here(head); here.status != 200) {
    return refuse(here.status, here.why);
  }
  const bool reads = head.method == "GET";
  if (!reads && head.method != "POST") return refuse(405, "GET or POST is expected");
  if (!reads && head.path == kLogin) {
    return head.field("content-type") == "application/json"
               ? BodyPlan{}
               : refuse(415, "application/json is expected");
  }
  if (reads && !starts(head.path, kApi) && !starts(head.path, kFiles)) {
    return page_file(head.path) ? BodyPlan{} : refuse(404, "there is no such page");
  }
  if (const Gate::Verdict may = gate_.allowed(head, !reads); may.status != 200) {
    return refuse(may.status, may.why);
  }
  if (reads || head.path != kUploads) {
    return reads || head.field("content-type") == "application/json"
               ? BodyPlan{}
               : refuse(415, "application/json is expected");
  }
  if (upload_name(head).empty()) return refuse(422, "this is not a name for a file");
  return {.kind = BodyPlan::Kind::file, .file = folder_.upload_file()};
}

void Site::handle(HttpRequest request, HttpReply reply) {
  try {
    if (request.head.method == "GET") return answer_read(request.head, reply);
    answer_change(request, reply);
  } catch (const std::exception& error) {
    reply(refusal_of(error));
  }
}

void Site::answer_read(const HttpHead& head, const HttpReply& reply) {
  if (head.path == "/api/state") {
    return on_study(
        reply, [this] { return whole_state(); }, false);
  }
  if (head.path == "/api/kinds") return reply(json_response(kinds_json()));
  if (head.path == "/api/events") {
    HttpResponse stream;
    stream.topics = kWorkbenchTopic | (head.query == "live" ? kLiveTopic : 0);
    stream.body = event_text("hello", "");
    return reply(std::move(stream));
  }
  if (starts(head.path, kFiles)) {
    const auto name = decoded(std::string_view(head.path).substr(kFiles.size()));
    if (!name || !is_plain_name(*name)) return reply(refusal(404, "there is no such file"));
    HttpResponse file;
    file.type = "application/octet-stream";
    try {
      file.file = folder_.existing(*name);
    } catch (const UsageError&) {
      return reply(refusal(404, "there is no such file"));
    }
    file.fields = {{"Content-Disposition", "attachment"}};
    return reply(std::move(file));
  }
  if (const auto file = page_file(head.path)) {
    HttpResponse response{.type = file->type, .body = std::string(file->text)};
    if (file->lasting) response.fields = {{"Cache-Control", "max-age=31536000, immutable"}};
    return reply(std::move(response));
  }
  reply(refusal(404, "there is no such page"));
}

void Site::log_in(const HttpRequest& request, const HttpReply& reply) const {
  const Json body = Json::parse(request.body, nullptr, false);
  const bool text = body.is_object() && body.contains("token") && body["token"].is_string();
  const std::string cookie = text ? gate_.cookie_for(body["token"].get<std::string>()) : "";
  if (cookie.empty()) return reply(refusal(401, "the token is not that of this page"));
  HttpResponse response = json_response({{"ok", true}});
  response.fields = {{"Set-Cookie", cookie}};
  reply(std::move(response));
}

void Site::answer_change(const HttpRequest& request, const HttpReply& reply) {
  const std::string path = request.head.path;
  if (path == kLogin) return log_in(request, reply);
  if (path == kUploads) return take_upload(request, reply);
  const auto body = std::make_shared<Json>(Json::parse(request.body, nullptr, false));
  if (!body->is_object()) return reply(refusal(400, "the body is no JSON object"));
  const auto change = [&](std::function<void()> work) {
    on_study(
        reply,
        [work = std::move(work)] {
          work();
          return Json{{"ok", true}};
        },
        true);
  };
  if (path == "/api/preview") return preview(*body, reply);
  if (path == "/api/alarm") return order(*body, reply);
  if (path == "/api/trigger") {
    live_.set_trigger(trigger_in(*body));
    return reply(json_response({{"ok", true}}));
  }
  if (path == "/api/capture") {
    return on_study(
        reply, [=, this] { return save_capture(*body); }, true);
  }
  if (path == "/api/cancel") {
    jobs_.cancel();
    return reply(json_response({{"ok", true}}));
  }
  if (path == "/api/curves") {
    const View view = view_in(*body);
    study_lane_.post([this, view, reply] {
      try {
        reply({.body = study_.curves(view)});
      } catch (const std::exception& error) {
        reply(refusal_of(error));
      }
    });
    return;
  }
  if (path == "/api/laws") {
    study_lane_.post([this, reply] {
      try {
        reply({.body = study_.laws()});
      } catch (const std::exception& error) {
        reply(refusal_of(error));
      }
    });
    return;
  }
  if (path == "/api/record")
    return change([=, this] { study_.open_record(text_in(*body, "name")); });
  if (path == "/api/import") {
    return change(
        [=, this] { (void)study_.import_record(text_in(*body, "name"), text_in(*body, "map")); });
  }
  if (path == "/api/model") return change([=, this] { study_.open_model(text_in(*body, "name")); });
  if (path == "/api/shipped") {
    return change([=, this] { study_.open_shipped(text_in(*body, "name")); });
  }
  if (path == "/api/new") {
    return change([=, this] { study_.make_model(text_in(*body, "kind"), values_in(*body)); });
  }
  if (path == "/api/ignore") return change([=, this] { study_.ignore(texts_in(*body, "spans")); });
  if (path == "/api/add") return change([=, this] { study_.add_effect(text_in(*body, "effect")); });
  if (path == "/api/beside") {
    return change([=, this] { study_.put_beside(text_in(*body, "name")); });
  }
  if (path == "/api/accept") return change([this] { study_.accept(); });
  if (path == "/api/undo") return change([this] { study_.undo(); });
  if (path == "/api/report") {
    return on_study(
        reply,
        [this] {
          return Json{{"file", study_.write_report()}};
        },
        true);
  }
  if (path == "/api/fit")
    return on_study(
        reply, [=, this] { return begin_fit(*body); }, true);
  if (path == "/api/diagnose") {
    return on_study(
        reply, [=, this] { return begin_diagnosis(*body); }, true);
  }
  reply(refusal(404, "there is no such request"));
}

void Site::take_upload(const HttpRequest& request, const HttpReply& reply) {
  const std::string name = upload_name(request.head);
  on_study(
      reply,
      [this, upload = request.upload, name, map = upload_map(request.head)]() mutable {
        // Without a name by the end of this block the file is removed, before the answer.
        const auto file = std::move(upload);
        const std::string kept = folder_.keep_upload(file->path(), name);
        try {
          const std::string path = folder_.existing(kept);
          const bool is_model = std::filesystem::path(kept).extension() == ".toml";
          if (is_model) {
            study_.open_model(kept);
          } else if (map.empty()) {
            study_.open_record(kept);
          } else {
            return Json{{"name", study_.import_record(kept, map)}};
          }
        } catch (const std::exception&) {
          std::error_code ignored;
          std::filesystem::remove(folder_.path_of(kept), ignored);
          throw;
        }
        return Json{{"name", kept}};
      },
      true);
}

void Site::preview(const Json& body, const HttpReply& reply) {
  const auto values = std::make_shared<ParameterValues>(values_in(body));
  const View view = view_in(body);
  study_lane_.post_latest(
      [this, values, view, reply] {
        try {
          reply({.body = study_.preview(*values, view)});
        } catch (const std::exception& error) {
          reply(refusal_of(error));
        }
      },
      [reply] {
        reply(json_response({{"superseded", true}}));
      });
}

void Site::on_study(const HttpReply& reply, std::function<Json()> work, bool changes) {
  if (study_lane_.waiting() >= kMostStudyWork) {
    return reply(refusal(503, "too much is waiting: try again"));
  }
  study_lane_.post([this, reply, work = std::move(work), changes] {
    if (!trouble_.empty()) check_folder(false);
    try {
      HttpResponse response = json_response(work());
      if (changes) publish_state();
      reply(std::move(response));
    } catch (const std::exception& error) {
      reply(refusal_of(error));
      if (changes) check_folder(dynamic_cast<const config::schema::RunError*>(&error) != nullptr);
    }
  });
}

Site::Json Site::save_capture(const Json& body) {
  const auto found = body.find("number");
  const std::uint64_t number =
      found != body.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
  const std::shared_ptr<const Capture> capture = live_.capture(number);
  if (!capture) {
    throw UsageError(number == 0 ? "nothing has been captured yet"
                                 : "capture " + std::to_string(number) + " is no longer kept");
  }
  const std::string file = folder_.fresh_name("capture.csv");
  config::record::write_csv(record_of(*capture), folder_.path_of(file));
  return {{"name", file}};
}

void Site::order(const Json& body, const HttpReply& reply) {
  if (!options_.allow_orders) {
    return reply(refusal(403, "orders are not allowed: spoolwatch serve --allow-orders"));
  }
  const std::string word = text_in(body, "order");
  // Nothing that moves the rod: arm, start, stop and the like are not orders of this page.
  if (word != protocol::kAcknowledge && word != protocol::kShelve && word != protocol::kUnshelve) {
    return reply(refusal(403, "allowed: ack, shelve, unshelve"));
  }
  Json request{{protocol::key::kCommand, word}, {protocol::key::kAlarm, text_in(body, "alarm")}};
  if (word == protocol::kShelve) {
    constexpr double kLongest_s = 86'400.0;
    const double time_s = number_in(body, "time_s", 0.0);
    if (!(time_s > 0.0 && time_s <= kLongest_s)) {
      return reply(refusal(422, "time_s: allowed: up to one day"));
    }
    request[protocol::key::kTime] = time_s;
  }
  control_lane_.post([this, request, reply] {
    try {
      control::OrderOptions options;
      options.socket = options_.control_socket;
      reply(json_response(control::give_order(request, options)));
    } catch (const std::exception& error) {
      reply(refusal_of(error));
    }
  });
}

}  // namespace workbench::serve
