#include "viewer/panel/banner_bar.hpp"

#include <QHBoxLayout>
#include <QProgressBar>
#include <QPushButton>

#include "viewer/panel/operator_action.hpp"
#include "viewer/panel/status_card.hpp"
#include "viewer/panel/theme.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kNoticeFor = 5 * kSecond;

}  // namespace

BannerBar::BannerBar(const std::function<void()>& cancel, QWidget* parent)
    : QFrame(parent),
      text_(new ElidedLabel(this)),
      advice_(new ElidedLabel(this)),
      progress_(new QProgressBar(this)),
      cancel_(new QPushButton("Cancel", this)) {
  setFixedHeight(scaled(34));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(scaled(12), 0, scaled(12), 0);
  row->setSpacing(scaled(16));
  row->addWidget(text_, 5);
  row->addWidget(advice_, 6);
  row->addWidget(progress_, 3);
  row->addWidget(cancel_);
  cancel_->setObjectName("small");
  cancel_->setFocusPolicy(Qt::NoFocus);
  cancel_->setToolTip(tooltip(OperatorAction::cancel));
  connect(cancel_, &QPushButton::clicked, this, cancel);
  show_job(std::nullopt);
  text_->set_size(scaled(14), true);
  advice_->set_size(scaled(13));
}

void BannerBar::show_notice(const Notice& notice) {
  notice_ = QString::fromStdString(notice.text);
  notice_kind_ = notice.kind;
  notice_until_ = monotonic_now() + kNoticeFor;
}

void BannerBar::show_job(const std::optional<std::pair<QString, double>>& job) {
  progress_->setVisible(job.has_value());
  cancel_->setVisible(job.has_value());
  if (!job) return;
  progress_->setValue(static_cast<int>(100 * job->second));
  progress_->setFormat(job->first + "  %p %");
}

void BannerBar::show_banner(const Banner& banner, const QString& otherwise) {
  const bool wrong = !banner.text.empty();
  const bool telling = monotonic_now() < notice_until_;
  const Mood told = notice_kind_ == Notice::Kind::refusal ? Mood::caution : Mood::good;
  const Mood mood = wrong ? banner.mood : telling ? told : Mood::off;
  const QString text = wrong ? QString::fromStdString(banner.text) : telling ? notice_ : otherwise;
  text_->set_text(mood == Mood::off ? text : mark(mood) + "  " + text);
  text_->set_colour(mood == Mood::off ? colour(palette::kText) : colour(mood));
  advice_->set_text(wrong ? QString::fromStdString(banner.advice) : QString());
  const char* ground = mood == Mood::bad ? "#3a1d14" : mood == Mood::caution ? "#33270d" : "#161c22";
  setStyleSheet(QString("linescope--BannerBar, QFrame { background: %1; }").arg(ground));
}

const QString& BannerBar::text() const {
  return text_->text();
}
const QString& BannerBar::advice() const {
  return advice_->text();
}

}  // namespace linescope
