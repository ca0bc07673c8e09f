# Prints the references of test_scaling.cpp: Bradley and Terry with BradleyTerry2 (without a penalty, which with many
# trials changes little) and, with Jeffreys' penalty, all three models with brglm2, whose rows are written here.
# Debian: r-cran-bradleyterry2, r-cran-brglm2. Usage: Rscript make_scaling.R
suppressPackageStartupMessages({library(BradleyTerry2); library(brglm2)})
options(digits = 10)
data(citations)
cat("citations, BradleyTerry2, relative to the first:\n")
sf <- countsToBinomial(citations)
m <- BTm(cbind(win1, win2), player1, player2, data = sf)
print(BTabilities(m)); cat("deviance", deviance(m), "\n")

jeffreys <- function(X, y, n, link) {
  m <- glm(cbind(y, n - y) ~ 0 + X, family = binomial(link), method = "brglmFit", type = "MPL_Jeffreys",
           epsilon = 1e-12, maxit = 1000)
  eta <- as.vector(X %*% coef(m)); p <- binomial(link)$linkinv(eta)
  dev <- 2 * sum(ifelse(y > 0, y * log(y / n / p), 0) + ifelse(y < n, (n - y) * log((1 - y / n) / (1 - p)), 0))
  cat(link, "coef", format(coef(m), digits = 10), "\n  se", format(sqrt(diag(vcov(m))), digits = 8),
      "\n  deviance", format(dev, digits = 10), "\n")
  m
}
# Five stimuli, all ordered pairs, 6 trials each: number of answers "second". The last was always chosen.
pairs <- expand.grid(second = 1:5, first = 1:5)
pairs <- pairs[pairs$first != pairs$second, ]
y <- c(4, 5, 5, 6,  3, 4, 5, 6,  1, 3, 4, 6,  2, 1, 3, 6,  0, 0, 0, 0)
n <- rep(6, 20)
X <- matrix(0, 20, 5)
for (i in 1:20) { X[i, pairs$second[i]] <- 1; X[i, pairs$first[i]] <- -1 }
X <- cbind(X[, -1], 1)
cat("pairs\n"); for (link in c("logit", "probit")) jeffreys(X, y, n, link)
# All quadruples of six stimuli, 12 trials each, the upper pair second: number of answers "second"
q <- t(combn(6, 4))
X <- matrix(0, 15, 6)
for (i in 1:15) { X[i, q[i, 4]] <- X[i, q[i, 4]] + 1; X[i, q[i, 3]] <- X[i, q[i, 3]] - 1
                  X[i, q[i, 2]] <- X[i, q[i, 2]] - 1; X[i, q[i, 1]] <- X[i, q[i, 1]] + 1 }
y <- c(8, 9, 12, 9, 11, 10, 8, 10, 11, 7, 9, 11, 9, 10, 9)
cat("quadruples\n"); m <- jeffreys(X[, -1], y, rep(12, 15), "probit")
cat("scale", format(coef(m) / coef(m)[5], digits = 10), "noise", format(1 / coef(m)[5], digits = 10), "\n")
