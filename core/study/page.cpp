#include "study/page.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "base/error.h"
#include "base/json_text.h"
#include "base/shell_word.h"
#include "study/picture.h"
#include "study/point_words.h"
#include "study/table_rows.h"
#include "svg/page.h"

namespace freeplay {
namespace {

constexpr std::uint64_t most_shown = 20'000;
constexpr std::size_t most_page_bytes = 2'900'000;
constexpr std::size_t listed_rows = 200;

constexpr std::string_view head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="generator" content="freeplay-report"><title>{}</title>
<style>body{{font:14px sans-serif;margin:2em;max-width:64em}}svg{{display:block;margin:1em 0;max-width:100%;height:auto}}
[data-point]{{cursor:pointer}}[data-point]:hover{{stroke:#000;stroke-width:2}}table{{border-collapse:collapse}}
td,th{{border:1px solid #ccc;padding:2px 8px;text-align:right}}pre{{background:#f4f4f4;padding:8px;white-space:pre-wrap}}
#point{{position:sticky;bottom:0;background:#fff;border-top:2px solid #444;padding:8px}}.wide{{overflow-x:auto}}</style></head>
<body><h1>{}</h1>
<p>{} points{}</p>
)";

constexpr std::string_view script = R"(<script>
const data = JSON.parse(document.getElementById('freeplay-study').textContent);
const place = document.getElementById('point');
// The folder of the study as a shell takes it, where the page is read from a disk.
const here = decodeURIComponent(location.pathname).replace(/\/[^/]*$/, '') + (data.folder ? '/' + data.folder : '');
const folder = location.protocol !== 'file:' ? 'DIR' : /^[\w\/.+-]+$/.test(here) ? here : "'" + here.replaceAll("'", "'\\''") + "'";
function show(index) {
  const point = data.points[index];
  place.textContent = '';
  const line = document.createElement('p');
  line.textContent = point ? data.columns.map((name, i) => name + ' = ' + point.row[i]).join('   ')
                           : 'point ' + index + ' is not on this page: freeplay study point DIR ' + index;
  place.append(line);
  if (!point) return;
  if (point.before !== undefined) {
    const note = document.createElement('p');
    note.textContent = 'In the study this point goes on from the end of point ' + point.before + '; the command starts anew.';
    place.append(note);
  }
  const command = document.createElement('pre'), button = document.createElement('button');
  command.textContent = point.command.replaceAll(' DIR/', ' ' + folder + '/');
  button.textContent = 'copy';
  button.onclick = () => navigator.clipboard.writeText(command.textContent);
  place.append(command, button);
  if (point.kept) {
    const link = document.createElement('a');
    link.href = (data.folder ? data.folder + '/' : '') + point.kept;
    link.textContent = ' its result';
    place.append(link);
  }
}
document.addEventListener('click', event => {
  const mark = event.target.closest('[data-point]');
  if (mark) show(mark.dataset.point);
});
</script>
</body></html>
)";

template <class Cells>
std::string table_row(const Cells& cells, const char* tag) {
  std::string row = "<tr>";
  for (const auto& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, svg::escaped(std::string(cell)));
  return row + "</tr>\n";
}

/// DIR stands for the folder of the study.
std::string command_of(const StudyPlan& plan, std::uint64_t index) {
  std::string command = "freeplay";
  for (const std::string& word : point_words(plan, "DIR", plan.point(index))) command += " " + shell_word(word);
  return command;
}

/// Of a row: what a click on its mark shows.
Json point_of(const StudyPlan& plan, const std::filesystem::path& folder, const TableRows& row) {
  const std::uint64_t index = row.index();
  Json point = {{"row", std::vector<std::string>(row.cells().begin(), row.cells().end())},
                {"command", command_of(plan, index)}};
  const UnitPlace at = plan.place_of(index);
  if (plan.chained() && at.place > 0) point["before"] = plan.unit_point(at.unit, at.place - 1);
  const std::string kept = fmt::format("kept/{:04}/{}", index / 1000, index);
  std::error_code ignored;
  if (std::filesystem::is_directory(folder / kept, ignored)) point["kept"] = kept;
  return point;
}

std::size_t bytes_of(const std::string& index, const Json& point) { return index.size() + point.dump().size() + 4; }

}  // namespace

std::string study_page(const OpenStudy& study, const std::filesystem::path& folder, const std::filesystem::path& seen) {
  const StudyPlan& plan = study.plan();
  TableRows first(folder);
  std::string body;
  for (const PictureRequest& request : picture_requests(plan)) {
    body += fmt::format("<h2>{}</h2>\n{}", svg::escaped(request.name), study_picture(study, folder, request));
  }
  std::string rows = table_row(first.columns(), "th");
  std::size_t listed = 0, listed_bytes = 0;
  for (; listed < listed_rows && first.next(); ++listed) {
    rows += table_row(first.cells(), "td");
    listed_bytes += bytes_of(std::string(first.cells().front()), point_of(plan, folder, first));
  }
  // Points get the room that is left, every k-th one where they need more.
  const std::size_t used = head.size() + script.size() + body.size() + rows.size() + 2000;
  const std::size_t room = most_page_bytes - std::min(used, most_page_bytes);
  const double bytes_of_all = static_cast<double>(listed_bytes) /
                              static_cast<double>(std::max<std::size_t>(listed, 1)) *
                              static_cast<double>(plan.points());
  const double share = 1.05 * bytes_of_all / static_cast<double>(std::max<std::size_t>(room, 1));
  const std::uint64_t every =
      std::max((plan.points() - 1) / most_shown + 1, static_cast<std::uint64_t>(std::ceil(std::min(share, 1e15))));
  Json points = Json::object();
  std::size_t bytes = 0, count = 0, left_out = 0;
  for (TableRows table(folder); table.next(); ++count) {
    Json point = count % every == 0 ? point_of(plan, folder, table) : Json();
    const std::size_t size = point.is_null() ? 0 : bytes_of(std::string(table.cells().front()), point);
    if (point.is_null() || bytes + size > room) {
      ++left_out;
      continue;
    }
    bytes += size;
    append(points, std::string(table.cells().front()), std::move(point));
  }
  const std::string note = left_out == 0 ? "" : fmt::format(", of which {} are not on this page", left_out);
  const std::string name = svg::escaped(plan.name());
  std::string page = fmt::format(fmt::runtime(head), name, name, count, note) + body +
                     "<div id=\"point\"><p>A click on a mark shows its point and its command; DIR is the folder of the "
                     "study.</p></div>\n"
                     "<h2>Table</h2>\n";
  if (count > listed_rows) page += fmt::format("<p>The first {} rows; all are in study.csv.</p>\n", listed_rows);
  std::string data =
      Json{{"folder", seen.generic_string()}, {"columns", first.columns()}, {"points", std::move(points)}}.dump();
  for (std::size_t at = data.find("</"); at != data.npos; at = data.find("</", at + 3)) data.insert(at + 1, "\\");
  return page + "<div class=\"wide\"><table>" + rows +
         "</table></div>\n<script type=\"application/json\" id=\"freeplay-study\">" + data + "</script>\n" +
         std::string(script);
}

}  // namespace freeplay
