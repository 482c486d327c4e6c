#include "viewer/script.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace linescope {
namespace {

/// One letter per word: w a word, n a number.
const std::map<std::string, std::string> kVerbs = {{"wait", "n"},       {"wait-for", "wnn"}, {"do", "w"},
                                                   {"view", "w"},       {"camepos", "nnnn"}, {"size", "nn"},
                                                   {"screenshot", "w"}, {"load", "w"},       {"save", "w"}};

bool is_number(const std::string& word) {
  std::istringstream in(word);
  double value = 0;
  return (in >> value) && in.eof() && std::isfinite(value);
}

std::optional<std::string> fault(const Step& step) {
  const auto verb = kVerbs.find(step.verb);
  if (verb == kVerbs.end()) return fmt::format("\"{}\" is no step", step.verb);
  if (step.words.size() != verb->second.size())
    return fmt::format("\"{}\" takes {} words, not {}", step.verb, verb->second.size(), step.words.size());
  for (std::size_t i = 0; i < step.words.size(); ++i)
    if (verb->second[i] == 'n' && !is_number(step.words[i]))
      return fmt::format("\"{}\" is no number", step.words[i]);
  return std::nullopt;
}

}  // namespace

Result<std::vector<Step>> parse_script(const std::string& text, const std::string& origin) {
  std::vector<Step> steps;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    Step step{.line = ++number, .verb = {}, .words = {}};
    std::istringstream words(line.substr(0, line.find('#')));
    if (!(words >> step.verb)) continue;
    for (std::string word; words >> word;) step.words.push_back(word);
    if (const auto wrong = fault(step))
      return fail(ErrorCode::invalid,
                  fmt::format("{}:{}: {}; docs/operators-guide.md lists the steps", origin, number, *wrong));
    steps.push_back(std::move(step));
  }
  return steps;
}

Result<std::vector<Step>> load_script(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    return fail(ErrorCode::not_found,
                fmt::format("script {} cannot be read: give --script a file with at least one step", file));
  return parse_script(text.str(), file);
}

}  // namespace linescope
