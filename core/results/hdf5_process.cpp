#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/byte_numbers.h"
#include "base/error.h"
#include "base/servant_process.h"
#include "results/hdf5_call.h"
#include "results/hdf5_reader.h"

namespace freeplay {
namespace {

namespace fs = std::filesystem;

enum Question : std::uint64_t {
  layout_of_file,
  rows_of,
  events_of_file,
  next_of,
  close_of,
  bearing_of,
  summary_of_file
};
enum AnswerKind : std::uint64_t { done, failed, no_more_memory };

/// Bytes that come from a process of this program.
class ServantMessage {
 public:
  explicit ServantMessage(std::string_view bytes) : numbers_(bytes, refuse) {}
  std::uint64_t number() { return numbers_.next(); }
  std::string text() { return std::string(numbers_.text(numbers_.next())); }
  std::vector<std::int64_t> list() {
    std::vector<std::int64_t> all;
    numbers_.next(all);
    return all;
  }
  template <class Take>
  void each(Take&& take) {
    for (std::uint64_t left = numbers_.next(); left > 0; --left) take();
  }

 private:
  static void refuse() { throw ServantGone("crashes"); }
  ByteNumbers<void (*)()> numbers_;
};

void append_list(std::string& out, const std::vector<RecordColumn>& columns) {
  append_bytes(out, static_cast<std::uint64_t>(columns.size()));
  for (const RecordColumn& column : columns) {
    for (const std::string* text : {&column.name, &column.unit, &column.long_name, &column.source}) {
      append_bytes(out, std::string_view(*text));
    }
  }
}

void append_list(std::string& out, const std::vector<std::string>& words) {
  append_bytes(out, static_cast<std::uint64_t>(words.size()));
  for (const std::string& word : words) append_bytes(out, std::string_view(word));
}

std::string bytes_of_layout(const RecordLayout& layout) {
  std::string out;
  append_list(out, layout.columns);
  append_list(out, layout.events);
  for (const auto* words : {&layout.joints, &layout.kinds, &layout.bearings}) append_list(out, *words);
  append_bytes(out, static_cast<std::uint64_t>(layout.attributes.size()));
  for (const auto& [name, text] : layout.attributes) {
    append_bytes(out, std::string_view(name));
    append_bytes(out, std::string_view(text));
  }
  return out;
}

RecordLayout layout_of_bytes(ServantMessage& message) {
  RecordLayout layout;
  for (auto* columns : {&layout.columns, &layout.events}) {
    message.each([&] {
      RecordColumn& column = columns->emplace_back();
      for (std::string* text : {&column.name, &column.unit, &column.long_name, &column.source}) *text = message.text();
    });
  }
  for (auto* words : {&layout.joints, &layout.kinds, &layout.bearings}) {
    message.each([&] { words->push_back(message.text()); });
  }
  message.each([&] {
    std::string name = message.text();
    layout.attributes.emplace_back(std::move(name), message.text());
  });
  return layout;
}

std::string_view bytes_of_numbers(std::span<const double> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

/// What answers: has the file open, and rows that are asked for bit by bit.
class Servant {
 public:
  explicit Servant(fs::path path) : path_(std::move(path)) {}

  void serve(std::string_view question, const ServantProcess::Send& send) {
    try {
      ServantMessage message(question);
      answer(message.number(), message, send);
    } catch (const Error& error) {
      send(failed, error.message() + "\n" + error.hint());
    } catch (const std::bad_alloc&) {
      send(no_more_memory, {});
    } catch (const std::exception& error) {
      send(failed, fmt::format("result '{}' cannot be read: {}", path_.string(), error.what()));
    }
  }

 private:
  void answer(std::uint64_t question, ServantMessage& message, const ServantProcess::Send& send) {
    if (question == layout_of_file) {
      reader_ = open_hdf5_here(path_);
      std::string bytes;
      append_bytes(bytes, static_cast<std::uint64_t>(reader_->sealed()));
      return send(done, bytes + bytes_of_layout(reader_->layout()));
    }
    if (question == bearing_of) return send(done, bytes_of_numbers(reader_->bearing(message.text())));
    if (question == summary_of_file) return send(done, reader_->summary());
    const std::uint64_t name = message.number();
    if (question == next_of) return send(done, bytes_of_numbers(sources_.at(name)->next()));
    if (question == close_of) {
      sources_.erase(name);
    } else if (question == events_of_file) {
      sources_[name] = reader_->open_events();
    } else {
      const std::vector<std::int64_t> columns = message.list();
      sources_[name] = reader_->open_rows(std::vector<std::size_t>(columns.begin(), columns.end()));
    }
    send(done, {});
  }

  fs::path path_;
  std::unique_ptr<OpenHdf5> reader_;
  std::map<std::uint64_t, std::unique_ptr<RowSource>> sources_;
};

ServantProcess::Serve servant(const fs::path& path) {
  renew_hdf5_lock();
  return [servant = std::make_shared<Servant>(path)](std::string_view question, const ServantProcess::Send& send) {
    servant->serve(question, send);
  };
}

/// An HDF5 file that another process reads for this one: on a damaged file the library may crash or never come back.
class Hdf5OfProcess : public ResultReader {
 public:
  explicit Hdf5OfProcess(const fs::path& path) : ResultReader(path.string()) {
    const Hdf5Lock lock;
    process_.emplace([&] { return servant(path); });
    ServantMessage message(ask(layout_of_file, {}).text());
    sealed_ = message.number() != 0;
    layout_ = layout_of_bytes(message);
  }

  bool sealed() const override { return sealed_; }
  std::unique_ptr<RowSource> open_rows(std::span<const std::size_t> columns) override {
    std::string list;
    append_bytes(list, std::vector<std::int64_t>(columns.begin(), columns.end()));
    return open(rows_of, list);
  }
  void events(const Take& take) override {
    const std::unique_ptr<RowSource> source = open(events_of_file, {});
    for (auto block = source->next(); !block.empty(); block = source->next()) take(block);
  }
  std::vector<double> bearing(const std::string& quantity) override {
    std::string text;
    append_bytes(text, std::string_view(quantity));
    const auto numbers = ask(bearing_of, text).body;
    return {numbers.begin(), numbers.end()};
  }
  std::string summary() override { return std::string(ask(summary_of_file, {}).text()); }

 private:
  class Rows : public RowSource {
   public:
    Rows(Hdf5OfProcess& reader, std::string name) : reader_(reader), name_(std::move(name)) {}
    ~Rows() override {
      try {
        reader_.ask(close_of, name_);
      } catch (const std::exception&) {  // with the process, its rows went
      }
    }
    std::span<const double> next() override {
      const auto numbers = reader_.ask(next_of, name_).body;
      block_.assign(numbers.begin(), numbers.end());
      return block_;
    }

   private:
    Hdf5OfProcess& reader_;
    const std::string name_;
    std::vector<double> block_;
  };

  std::unique_ptr<RowSource> open(Question question, const std::string& more) {
    std::string name;
    append_bytes(name, ++opened_);
    ask(question, name + more);
    return std::make_unique<Rows>(*this, name);
  }

  ServantProcess::Answer ask(Question question, const std::string& more) {
    std::string bytes;
    append_bytes(bytes, static_cast<std::uint64_t>(question));
    try {
      const ServantProcess::Answer answer = process_->ask(bytes + more);
      if (answer.kind == no_more_memory) throw std::bad_alloc();
      if (answer.kind == failed) {
        const std::string_view text = answer.text(), message = text.substr(0, text.find('\n'));
        const std::string_view hint = text.substr(std::min(message.size() + 1, text.size()));
        throw Error(Error::Category::file, "unreadable-result", std::string(message), {file_, 0, 0}, std::string(hint));
      }
      return answer;
    } catch (const ServantGone& gone) {
      unreadable_result(file_, fmt::format("it is damaged: the HDF5 library {} while it reads it", gone.what()), 0,
                        what_to_do_with_a_damaged_file);
    }
  }

  std::optional<ServantProcess> process_;
  bool sealed_ = false;
  std::uint64_t opened_ = 0;
};

}  // namespace

std::unique_ptr<ResultReader> open_hdf5(const fs::path& path) { return std::make_unique<Hdf5OfProcess>(path); }

}  // namespace freeplay
