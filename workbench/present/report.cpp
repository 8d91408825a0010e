#include "workbench/present/report.h"

#include <algorithm>
#include <array>
#include <ctime>

#include "config/record/whole_file.h"
#include "config/schema/product_version.h"
#include "config/units/quantity.h"
#include "workbench/present/assets.h"
#include "workbench/present/plot_data.h"
#include "workbench/present/text.h"

namespace workbench::present {

namespace {

// Nothing may be fetched: the page works alone, and a slip cannot send anything out.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:";

std::string paragraph(const std::string& text) { return "<p>" + html(typeset(text)) + "</p>\n"; }

std::string now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &local);
  return text.data();
}

std::string anchor(std::size_t number) { return "section-" + std::to_string(number + 1); }

std::string state_class(ReportState state) {
  constexpr std::array<const char*, 3> kNames{"good", "warn", "bad"};
  return kNames[static_cast<std::size_t>(state)];
}

std::string header(const Report& report) {
  std::string out = "<header class=\"" + state_class(report.state) +
                    "\"><div><a class=\"name\" href=\"#top\">" + html(report.title) + "</a><nav>";
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    out += "<a href=\"#" + anchor(i) + "\">" + html(report.sections[i].heading) + "</a>";
  }
  return out + "</nav></div></header>\n";
}

std::string top(const Report& report) {
  std::string out = "<h1>" + html(report.title) + "</h1>\n<div class=\"verdict " +
                    state_class(report.state) + "\"><p class=\"words\">" +
                    html(typeset(report.verdict)) + "</p>\n";
  for (const std::string& line : report.summary) out += paragraph(line);
  out += "</div>\n";
  if (!report.facts.empty()) out += "<dl class=\"facts\">\n";
  for (const Fact& fact : report.facts) {
    out += "<div><dt>" + html(fact.label) + "</dt><dd>" + html(typeset(fact.value)) +
           (fact.unit.empty()
                ? ""
                : " <span>" + html(typeset(config::units::axis_unit(fact.unit))) + "</span>") +
           "</dd></div>\n";
  }
  if (!report.facts.empty()) out += "</dl>\n";
  const auto command = [&](const char* what, const std::string& words) {
    if (words.empty()) return;
    out += std::string("<div class=\"command\"><span>") + what + "</span><code>" + html(words) +
           "</code></div>\n";
  };
  command("Made by", report.command);
  command("Next", report.next_command);
  return out;
}

std::string table(const Table& table) {
  const auto cell = [&](const char* tag, std::size_t column, const std::string& text) {
    const bool numeric = table.columns[column].numeric;
    return std::string("<") + tag + (numeric ? " class=\"n\">" : ">") + text + "</" + tag + ">";
  };
  std::string out = "<div class=\"table\"><table>";
  if (!table.caption.empty()) out += "<caption>" + html(typeset(table.caption)) + "</caption>";
  out += "\n<thead><tr>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string& unit = table.columns[i].unit;
    out += cell(
        "th", i,
        html(typeset(table.columns[i].name)) +
            (unit.empty() ? ""
                          : " <span>" + html(typeset(config::units::axis_unit(unit))) + "</span>"));
  }
  out += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const auto& marked = table.marked_rows;
    out += std::find(marked.begin(), marked.end(), r) != marked.end() ? "<tr class=\"marked\">"
                                                                      : "<tr>";
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      out += cell("td", i, i < table.rows[r].size() ? html(typeset(table.rows[r][i])) : "");
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

/// The section; appends the JSON of its plots to `data`.
std::string section_text(const Section& section, std::size_t number, std::string& data,
                         std::size_t& plots) {
  std::string tables;
  for (const Table& one : section.tables) tables += table(one);
  std::string figures;
  for (const Plot& plot : section.plots) {
    const PlotText text = plot_text(plot);
    figures += figure(plot, text.note, plots++);
    data += (data.empty() ? "" : ",\n") + text.json;
  }
  if (!figures.empty()) figures = "<div class=\"plots\">\n" + figures + "</div>\n";
  std::string out =
      "<section id=\"" + anchor(number) + "\">\n<h2>" + html(section.heading) + "</h2>\n";
  for (const std::string& text : section.paragraphs) out += paragraph(text);
  return out + (section.tables_first ? tables + figures : figures + tables) + "</section>\n";
}

std::string footer(const Report& report) {
  return "<footer><p>spoolwatch " + html(std::string(config::schema::product_version())) + ", " +
         html(report.made_at.empty() ? now() : report.made_at) +
         ". Drag in a plot to zoom, double-click to reset. Plots by Chart.js (MIT "
         "licence, in this file).</p></footer>\n";
}

}  // namespace

std::string render(const Report& report) {
  std::string data;
  std::string body;
  std::size_t plots = 0;
  for (std::size_t i = 0; i < report.sections.size(); ++i) {
    body += section_text(report.sections[i], i, data, plots);
  }
  std::string page = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta http-equiv=\"Content-Security-Policy\" content=\"" + std::string(kPolicy) +
          "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
          html(report.title) + "</title>\n<style>\n";
  page += page_style();
  page += "</style>\n</head>\n<body id=\"top\" data-plots=\"" + std::to_string(plots) + "\">\n";
  page += header(report) + "<main>\n" + top(report);
  page +=
      "<noscript><p>The plots need JavaScript; the figures in the tables do not.</p>"
      "</noscript>\n";
  page += body + footer(report) + "</main>\n";
  page += "<script type=\"application/json\" id=\"data\">[\n" + data + "\n]</script>\n<!--\n";
  page += plot_library_licence();
  page += "-->\n<script>\n";
  page += plot_library();
  page += "\n</script>\n<script>\n'use strict';\n(() => {\n";
  for (const std::string_view part : {page_series(), page_marks(), page_axes(), page_program()}) {
    page += part;
  }
  return page + "})();\n</script>\n</body>\n</html>\n";
}

void write_report(const Report& report, const std::filesystem::path& file) {
  config::record::write_whole(file, render(report));
}

}  // namespace workbench::present
