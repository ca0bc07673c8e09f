# fit_rtdists.R FOLDER PARTICIPANTS STARTS: writes trials of rtdists' data sets speed_acc and rr98 into FOLDER, and the maximum
# of the likelihood that rtdists finds for each participant and instruction, from so many starts. Trials that the data
# set marks as censored or as outliers are left out.
suppressMessages(library(rtdists))
arguments <- commandArgs(TRUE)
folder <- arguments[1]
people <- as.integer(arguments[2])
starts <- as.integer(arguments[3])
data(speed_acc)
data(rr98)
words <- subset(speed_acc, !censor)
words <- data.frame(set = "speed_acc", id = as.character(words$id), condition = as.character(words$condition),
                    difficulty = ifelse(words$stim_cat == "word", 1, 0), upper = as.integer(words$response == "word"),
                    correct = as.integer(as.character(words$stim_cat) == as.character(words$response)), time_s = words$rt)
light <- subset(rr98, !outlier)
light <- data.frame(set = "rr98", id = as.character(light$id), condition = as.character(light$instruction),
                    difficulty = pmin(light$strength %/% 6, 5), upper = as.integer(light$response == "light"),
                    correct = as.integer(as.logical(light$correct)), time_s = light$rt)
light$correct[is.na(light$correct)] <- 0
trials <- rbind(words, light)
write.csv(trials, file.path(folder, "trials.csv"), row.names = FALSE)
set.seed(1)
found <- NULL
for (person in head(unique(words$id), people)) for (instruction in unique(words$condition)) {
  cell <- subset(words, id == person & condition == instruction)
  levels <- sort(unique(cell$difficulty))
  which <- match(cell$difficulty, levels)
  side <- ifelse(cell$upper == 1, "upper", "lower")
  deviance <- function(p) {
    a <- exp(p[1]); t0 <- exp(p[2]); start <- plogis(p[3])
    if (t0 >= min(cell$time_s)) return(1e6)
    density <- ddiffusion(cell$time_s, side, a = a, v = p[3 + which], t0 = t0, z = start * a, precision = 5)
    if (any(!is.finite(density)) || any(density <= 0)) return(1e6)
    -sum(log(density))
  }
  best <- NULL
  for (i in seq_len(starts)) {
    from <- c(log(runif(1, 0.7, 1.8)), log(min(cell$time_s) * runif(1, 0.4, 0.9)), rnorm(1, 0, 0.1),
              (levels - mean(levels)) * runif(1, 1, 4))
    fit <- nlminb(from, deviance, control = list(rel.tol = 1e-12, iter.max = 500, eval.max = 1000))
    if (is.null(best) || fit$objective < best$objective) best <- fit
  }
  p <- best$par
  found <- rbind(found, data.frame(id = person, condition = instruction, boundary = exp(p[1]), nondecision_s = exp(p[2]),
                                   start = plogis(p[3]), drift_0 = p[4], drift_1 = p[5]))
}
write.csv(found, file.path(folder, "fits.csv"), row.names = FALSE)
