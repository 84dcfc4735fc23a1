// Include resolution and the way back from a compiler's log to files. Conditions are not evaluated but for the ones
// that separate C++ from GLSL: an include in any other would enter or not by chance of order, so it is turned down.
#include "gpu/shader_source.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/files.h"

namespace brickfield {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMostShaderBytes = 16u << 20;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// The line without comments; inComment carries an open /* over to the next line.
std::string withoutComments(std::string_view line, bool& inComment) {
  std::string kept;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::string_view two = line.substr(i, 2);
    if (inComment) {
      if (two == "*/") inComment = false, ++i;
    } else if (two == "/*") {
      inComment = true, ++i, kept += ' ';
    } else if (two == "//") {
      break;
    } else {
      kept += line[i];
    }
  }
  return kept;
}

struct Directive {
  std::string name;     // "include", empty for no directive
  std::string argument; // the rest, trimmed
};

Directive directiveOf(std::string_view line) {
  std::string_view text = trimmed(line);
  if (text.empty() || text.front() != '#') return {};
  text = trimmed(text.substr(1));
  const std::size_t end = text.find_first_of(" \t\"<(!");
  const std::string_view name = text.substr(0, end);
  return {std::string(name),
          std::string(end == std::string_view::npos ? std::string_view() : trimmed(text.substr(end)))};
}

enum class Branch { Glsl, Cpp, Guard, Unknown };

Branch branchOf(const Directive& directive) {
  std::string condition = directive.argument;
  std::erase_if(condition, [](char c) { return c == ' ' || c == '\t'; });
  const bool defined = directive.name == "ifdef";
  const bool undefined = directive.name == "ifndef";
  if (defined && condition == "__cplusplus") return Branch::Cpp;
  if (undefined && condition == "__cplusplus") return Branch::Glsl;
  if (defined && condition == "BRICKFIELD_GLSL") return Branch::Glsl;
  if (undefined && condition == "BRICKFIELD_GLSL") return Branch::Cpp;
  if (condition == "defined(__cplusplus)" || condition == "!defined(BRICKFIELD_GLSL)") return Branch::Cpp;
  if (condition == "!defined(__cplusplus)" || condition == "defined(BRICKFIELD_GLSL)") return Branch::Glsl;
  return Branch::Unknown;
}

Branch opposite(Branch branch) {
  return branch == Branch::Cpp ? Branch::Glsl : branch == Branch::Glsl ? Branch::Cpp : Branch::Unknown;
}

class Assembler {
public:
  Assembler(const fs::path& root, const ShaderPreamble& preamble, FileTimes* visited) : root_(root), visited_(visited) {
    out_.text = "#version 450 core\n";
    for (const std::string& extension : preamble.extensions)
      out_.text += fmt::format("#extension {} : require\n", extension);
    out_.text += "#define BRICKFIELD_GLSL 1\n";
    for (const auto& [name, value] : preamble.defines) out_.text += fmt::format("#define {} {}\n", name, value);
  }

  // where  "FILE:LINE: " of the include, or empty
  void addFile(const std::string& path, const std::string& where) {
    if (const auto open = std::ranges::find(open_, path); open != open_.end()) {
      std::vector<std::string> chain(open, open_.end());
      chain.push_back(path);
      throw Failure(fmt::format("{}include cycle {}", where, fmt::join(chain, " -> ")));
    }
    if (std::ranges::find(out_.files, path) != out_.files.end()) return;
    const std::string text = readText(path, where);
    const std::size_t index = out_.files.size();
    out_.files.push_back(path);
    open_.push_back(path);
    startLine(1, index);
    addLines(path, index, text);
    open_.pop_back();
  }

  ShaderText take() { return std::move(out_); }

private:
  struct State {
    std::vector<Branch> branches;
    std::string guard; // X after `#ifndef X` as the first directive, until the next one
    bool sawDirective = false;
    bool inComment = false;
  };

  std::string readText(const std::string& path, const std::string& where) {
    const fs::path relative = fs::path(path).lexically_normal();
    if (path.empty() || relative.is_absolute() || relative.string() != path || *relative.begin() == "..")
      throw Failure(fmt::format("{}\"{}\" is no plain path below the shader folder", where, path));
    if (visited_) visited_->emplace(path, changeTime(root_ / relative));
    try {
      const std::vector<std::byte> bytes = readFile(root_ / relative, kMostShaderBytes);
      std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      if (text.find('\0') != std::string::npos) throw Failure(fmt::format("{}{}: holds a zero byte", where, path));
      return text;
    } catch (const BadInput& error) {
      throw Failure(fmt::format("{}{}", where, error.what()));
    }
  }

  void startLine(std::size_t line, std::size_t fileIndex) {
    if (!out_.text.ends_with('\n')) out_.text += '\n';
    out_.text += fmt::format("#line {} {}\n", line, fileIndex);
  }

  void addLines(const std::string& path, std::size_t index, std::string_view rest) {
    State state;
    for (std::size_t line = 1; !rest.empty(); ++line) {
      const std::size_t end = rest.find('\n');
      const std::string_view text = rest.substr(0, end);
      rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
      const bool startsInComment = state.inComment;
      const Directive directive = directiveOf(withoutComments(text, state.inComment));
      const std::string where = fmt::format("{}:{}: ", path, line);
      if (directive.name == "version") throw Failure(where + "#version stands in front already");
      if (directive.name == "include") {
        if (startsInComment || state.inComment)
          throw Failure(where + "an include shares its line with a comment's end");
        include(directive.argument, state, where);
        startLine(line + 1, index);
      } else {
        follow(directive, state);
        // `#pragma once` is what includes do anyway; drivers warn about it.
        const bool once = directive.name == "pragma" && directive.argument == "once";
        if (!once) out_.text += text;
        out_.text += '\n';
      }
      if (!directive.name.empty()) state.sawDirective = state.sawDirective || directive.name != "pragma";
    }
    if (!state.branches.empty()) throw Failure(fmt::format("{}: {} #if without #endif", path, state.branches.size()));
  }

  static void follow(const Directive& directive, State& state) {
    const std::string& name = directive.name;
    if (name.empty()) return;
    if (name == "define" && !state.guard.empty() && directive.argument == state.guard)
      state.branches.back() = Branch::Guard;
    state.guard.clear();
    if (name == "if" || name == "ifdef" || name == "ifndef") {
      if (name == "ifndef" && !state.sawDirective) state.guard = directive.argument;
      state.branches.push_back(branchOf(directive));
    } else if (name == "else" && !state.branches.empty()) {
      state.branches.back() = opposite(state.branches.back());
    } else if (name == "elif" && !state.branches.empty()) {
      state.branches.back() = Branch::Unknown;
    } else if (name == "endif" && !state.branches.empty()) {
      state.branches.pop_back();
    }
  }

  void include(const std::string& argument, State& state, const std::string& where) {
    const bool isSystem = argument.starts_with('<');
    const bool inCpp = std::ranges::find(state.branches, Branch::Cpp) != state.branches.end();
    if (isSystem || inCpp) return;
    if (argument.size() < 2 || argument.front() != '"' || argument.back() != '"')
      throw Failure(where + "an include names a file in quotes");
    if (std::ranges::find(state.branches, Branch::Unknown) != state.branches.end())
      throw Failure(where + "an include must not stand inside a condition; put it before");
    addFile(argument.substr(1, argument.size() - 2), where);
  }

  fs::path root_;
  FileTimes* visited_;
  ShaderText out_;
  std::vector<std::string> open_;
};

struct LogMessage {
  std::size_t source = 0;
  std::size_t line = 0;
  std::string_view kind; // what a prefix said that is cut off, else empty
  std::string_view text;
};

// Reads a line of a log from its left end.
class LogReader {
public:
  explicit LogReader(std::string_view line) : rest_(line) {}

  // Mesa "1:12(3): error: ...", NVIDIA "1(12) : error C0000: ...", AMD and Intel "ERROR: 1:12: ..."
  std::optional<LogMessage> message() {
    LogMessage found;
    if (take("ERROR:")) found.kind = "error: ";
    if (take("WARNING:")) found.kind = "warning: ";
    if (!takeNumber(found.source)) return std::nullopt;
    std::size_t column = 0;
    if (take("(")) {
      if (!takeNumber(found.line) || !take(")")) return std::nullopt;
    } else {
      if (!take(":") || !takeNumber(found.line)) return std::nullopt;
      if (take("(") && (!takeNumber(column) || !take(")"))) return std::nullopt;
    }
    if (!take(":")) return std::nullopt;
    found.text = rest_;
    return found;
  }

private:
  bool take(std::string_view token) {
    if (!rest_.starts_with(token)) return false;
    rest_ = trimmed(rest_.substr(token.size()));
    return true;
  }
  bool takeNumber(std::size_t& number) {
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
    if (error != std::errc()) return false;
    rest_ = trimmed(rest_.substr(static_cast<std::size_t>(end - rest_.data())));
    return true;
  }

  std::string_view rest_;
};

} // namespace

ShaderText assembleShader(const fs::path& root, std::string_view path, const ShaderPreamble& preamble,
                          FileTimes* visited) {
  Assembler assembler(root, preamble, visited);
  assembler.addFile(std::string(path), "");
  return assembler.take();
}

fs::file_time_type changeTime(const fs::path& path) {
  std::error_code ec;
  const fs::file_time_type time = fs::last_write_time(path, ec);
  return ec ? fs::file_time_type::min() : time;
}

std::vector<std::string> readableLog(std::string_view log, const std::vector<std::string>& files) {
  std::vector<std::string> messages;
  while (!log.empty()) {
    const std::size_t end = log.find('\n');
    const std::string_view line = trimmed(log.substr(0, end));
    log = end == std::string_view::npos ? std::string_view() : log.substr(end + 1);
    if (line.find_first_not_of('\0') == std::string_view::npos) continue;
    const std::optional<LogMessage> message = LogReader(line).message();
    if (message && message->source < files.size())
      messages.push_back(
          fmt::format("{}:{}: {}{}", files[message->source], message->line, message->kind, message->text));
    else
      messages.emplace_back(line);
  }
  return messages;
}

} // namespace brickfield
