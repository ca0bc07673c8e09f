# Fits the data of mixed_data.csv with lme4 and writes mixed_lme4.csv. Run in this folder:
#   Rscript make_mixed.R
# It also simulates the data (seed 23), so this script alone makes both tables.
suppressMessages(library(lme4))

draw <- function(name, people, levels, trials, guess, lapse, core, b0, b1, sd0, sd1, r) {
  rows <- list()
  for (i in seq_len(people)) {
    a <- rnorm(1); c <- r * a + sqrt(1 - r^2) * rnorm(1)
    z <- (b0 + sd0 * a) + (b1 + sd1 * c) * levels
    p <- guess + (1 - guess - lapse) * core(z)
    rows[[i]] <- data.frame(set = name, person = sprintf("P%02d", i), level = levels, trials = trials,
                            positive = rbinom(length(levels), trials, p))
  }
  do.call(rbind, rows)
}

# A link function for lme4: that of m-alternative forced choice, guess + (1 - guess) core(z).
forced <- function(guess, core, density, inverse, name) {
  structure(list(linkfun = function(mu) inverse(pmin(pmax((mu - guess) / (1 - guess), 1e-10), 1 - 1e-10)),
                 linkinv = function(eta) pmin(pmax(guess + (1 - guess) * core(eta), 1e-12), 1 - 1e-12),
                 mu.eta = function(eta) (1 - guess) * density(eta),
                 valideta = function(eta) TRUE, name = name), class = "link-glm")
}
weibull <- function(z) 1 - exp(-exp(z))

set.seed(23)
data <- rbind(
  draw("sides", 12, c(-12, -8, -4, -2, 2, 4, 8, 12), 20, 0, 0, pnorm, 0.3, 0.18, 0.5, 0.05, 0.3),
  draw("few", 6, c(-3, -1, 1, 3), 8, 0, 0, plogis, -0.4, 0.7, 0.9, 0.2, -0.2),
  draw("contrast", 15, c(-26, -22, -19, -16, -12, -8), 24, 0.5, 0, weibull, 2.9, 0.16, 0.6, 0.03, 0.5))
write.csv(data, "mixed_data.csv", row.names = FALSE, quote = FALSE)

links <- list(sides = "probit", few = "logit",
              contrast = forced(0.5, weibull, function(z) exp(z - exp(z)),
                                function(p) log(-log1p(-p)), "weibull2afc"))
out <- list()
for (name in names(links)) {
  part <- data[data$set == name, ]
  start <- if (name == "contrast") list(theta = c(0.5, 0, 0.1), fixef = c(2.9, 0.16))
  m <- glmer(cbind(positive, trials - positive) ~ level + (1 + level | person), part,
             family = binomial(links[[name]]), start = start,
             control = glmerControl(optimizer = "bobyqa", tolPwrss = 1e-11,
                                    optCtrl = list(maxfun = 1e5, rhobeg = 2e-3, rhoend = 2e-9),
                                    check.conv.grad = "ignore"))
  v <- VarCorr(m)$person
  constant <- sum(lchoose(part$trials, part$positive))
  b <- coef(m)$person
  row <- function(quantity, value) data.frame(set = name, quantity = quantity, value = signif(value, 10))
  out[[name]] <- rbind(
    row("intercept", fixef(m)[[1]]), row("rate", fixef(m)[[2]]),
    row("intercept_se", sqrt(vcov(m)[1, 1])), row("rate_se", sqrt(vcov(m)[2, 2])),
    row("intercept_sd", attr(v, "stddev")[[1]]), row("rate_sd", attr(v, "stddev")[[2]]),
    row("correlation", attr(v, "correlation")[1, 2]),
    row("log_likelihood", as.numeric(logLik(m)) - constant),
    do.call(rbind, lapply(rownames(b), function(p) row(paste0("threshold_", p), -b[p, 1] / b[p, 2]))))
}
header <- sprintf("# lme4 %s, R %s.%s", packageVersion("lme4"), R.version$major, R.version$minor)
writeLines(header, "mixed_lme4.csv")
suppressWarnings(write.table(do.call(rbind, out), "mixed_lme4.csv", append = TRUE, sep = ",",
                             row.names = FALSE, quote = FALSE))
