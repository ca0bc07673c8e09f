# Fits the tables of a study with lme4, and compares them with the report.
#   turnpoint report --study --db lab.sqlite --tables tables
#   Rscript study.R tables
# The model is that of the report: a psychometric function whose intercept and slope differ between participants.
# Prints what, condition, value of lme4 (empty if it finds no fit), value of the report; and for times of right answers: what, first
# condition, second condition, difference of their logarithms (second minus first, as in the report), standard error.
suppressMessages(library(lme4))

folder <- commandArgs(trailingOnly = TRUE)[1]
if (is.na(folder)) stop("name the folder of the tables: Rscript study.R tables")
table_of <- function(name) {
  # a participant or a condition may be called NA, 007 or TRUE
  header <- names(read.csv(file.path(folder, name), nrows = 0, check.names = FALSE))
  texts <- intersect(header, c("participant", "condition", "procedure", "block", "measure", "response"))
  read.csv(file.path(folder, name), na.strings = "", colClasses = setNames(rep("character", length(texts)), texts))
}
answers <- subset(table_of("answers.csv"), excluded == "no")
groups <- table_of("groups.csv")
label <- function(condition) ifelse(is.na(condition) | condition == "", "all trials", condition)
answers$condition <- label(answers$condition)
groups$condition <- label(groups$condition)

# A condition of two factors has a comma in its name.
quoted <- function(name) ifelse(grepl(",", name), dQuote(name, FALSE), name)

# The link of a function between guess and 1 - lapse.
link <- function(name, guess, lapse) {
  range <- 1 - guess - lapse
  core <- switch(name, normal = pnorm, logistic = plogis, weibull = function(z) 1 - exp(-exp(z)))
  density <- switch(name, normal = dnorm, logistic = dlogis, weibull = function(z) exp(z - exp(z)))
  inverse <- switch(name, normal = qnorm, logistic = qlogis, weibull = function(p) log(-log1p(-p)))
  structure(list(linkfun = function(mu) inverse(pmin(pmax((mu - guess) / range, 1e-9), 1 - 1e-9)),
                 linkinv = function(eta) pmin(pmax(guess + range * core(eta), 1e-12), 1 - 1e-12),
                 mu.eta = function(eta) range * density(eta), valideta = function(eta) TRUE,
                 name = paste(name, "between asymptotes")), class = "link-glm")
}

for (i in seq_len(nrow(groups))) {
  group <- groups[i, ]
  part <- answers[answers$condition == group$condition, ]
  if (any(part$weight != 1)) {
    message("no comparison for ", group$condition, ": unsure answers count as fractions with a weight, not as lme4 counts")
    next
  }
  # lme4 wants levels of the order of 1
  centre <- mean(part$axis); width <- sd(part$axis)
  part$x <- (part$axis - centre) / width
  start <- list(fixef = c(group$intercept + group$rate * centre, group$rate * width))
  model <- tryCatch(suppressMessages(suppressWarnings(glmer(
    cbind(positive, trials - positive) ~ x + (1 + x | participant), part, start = start,
    family = binomial(link(group$`function`, group$guess, group$lapse)),
    control = glmerControl(optimizer = "bobyqa", optCtrl = list(maxfun = 1e5))))),
    error = function(problem) {
      # for example if a participant is always right
      message("lme4 finds no fit for ", group$condition, ": ", conditionMessage(problem))
      NULL
    })
  theirs <- c(threshold = NA, rate = NA, log_likelihood = NA)
  if (!is.null(model))
    theirs <- c(threshold = -fixef(model)[[1]] / fixef(model)[[2]] * width + centre, rate = fixef(model)[[2]] / width,
                log_likelihood = as.numeric(logLik(model)) - sum(lchoose(part$trials, part$positive)))
  ours <- c(threshold = -group$intercept / group$rate, rate = group$rate, log_likelihood = group$log_likelihood)
  for (what in names(ours))
    cat(what, quoted(group$condition), ifelse(is.na(theirs[[what]]), "", sprintf("%.8g", theirs[[what]])),
        sprintf("%.8g\n", ours[[what]]), sep = ",")
}

# Response times of right answers: log time by condition, with participants as random effects.
trials <- subset(table_of("trials.csv"), excluded == "no" & outcome == "answered" & correct == 1)
# the conditions in the order of the protocol, so that the signs are those of the report
order <- unique(label(table_of("measures.csv")$condition))
trials$condition <- label(trials$condition)
trials$condition <- factor(trials$condition, levels = order[order %in% trials$condition])
order <- levels(trials$condition)
# the random effects need participants with several trials, and the differences participants with several conditions
compared <- rowSums(table(trials$participant, trials$condition) > 0) > 1
if (length(order) > 1 && sum(compared) > 1) {
  model <- suppressMessages(lmer(log(response_time_s) ~ condition + (1 | participant), trials))
  for (second in order[-1]) {
    name <- paste0("condition", second)
    cat(sprintf("log_response_time,%s,%s,%.6g,%.6g\n", quoted(order[1]), quoted(second), fixef(model)[[name]],
                sqrt(vcov(model)[name, name])))
  }
}
