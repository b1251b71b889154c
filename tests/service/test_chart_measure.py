"""The errors of a chart, on pictures whose bias and variance are known."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from renderer.pipeline import Picture
from service.chart import measure
from service.chart.compare import Point, equal
from service.chart.flip import exposures, flip
from service.chart.record import Record

HEIGHT, WIDTH = 60, 80
PIXELS = HEIGHT * WIDTH
ALL = np.ones((HEIGHT, WIDTH), np.bool_)
COLOUR = np.array([1.0, 0.5, 0.25])
TINT = float(np.mean(COLOUR**2))  # the mean square of what one number makes of three channels


def record(images: list[NDArray[np.float64]], kind: type[np.float32] | type[np.float64] = np.float64) -> Record:
    made = Record(kind)
    for image in images:
        picture = Picture(image.astype(np.float64), {}, {"total": 1.0, "compile": 0.25, "solids": 0.0}, 7, {})
        made.add(picture, wall=2.0)
    return made


def noisy(
    generator: np.random.Generator, count: int, sigma: float, bias: float = 0.0, kind: type[np.float64] = np.float64
) -> Record:
    """Pictures of a truth that is a ramp, plus a bias of random sign a pixel, plus noise that the channels share."""
    truth = np.linspace(0.5, 1.5, PIXELS).reshape(HEIGHT, WIDTH, 1) * np.ones(3)
    signs = np.sign(np.random.Generator(np.random.PCG64(99)).standard_normal((HEIGHT, WIDTH, 1)))
    grain = generator.standard_normal((count, HEIGHT, WIDTH, 1)) * sigma
    return record([truth + (one + bias * signs) * COLOUR for one in grain], kind)


def test_moments_are_the_mean_and_the_unbiased_variance() -> None:
    images = list(np.random.Generator(np.random.PCG64(1)).random((5, HEIGHT, WIDTH, 3)))
    made = record(images)
    assert made.mean == pytest.approx(np.mean(images, axis=0), abs=1e-12)
    assert made.variance == pytest.approx(np.var(images, axis=0, ddof=1), abs=1e-12)
    assert (made.count, made.median, made.wall, made.bytes) == (5, 0.75, 10.0, 7)


@pytest.mark.parametrize("passes", [2, 3, 20])
def test_an_exact_picture_scatters_by_the_floor(passes: int) -> None:
    """The mean square of nothing, over many references: mean 0, standard deviation floor^2.

    Of 200 trials the mean is within 4 / sqrt(200) of a deviation from 0. Its fourth root's estimate from one trial
    scatters by next to nothing (4,800 pixels), and the deviation over 200 trials by 1 / sqrt(400) = 5%: 4 of those.
    """
    generator = np.random.Generator(np.random.PCG64(passes))
    exact = noisy(generator, 1, 0.0)
    trials, floors = [], []
    for _ in range(200):
        reference = noisy(generator, passes, 0.1)
        square, _ = measure._total(exact, reference, ALL, None, False)
        trials.append(square.mean)
        floors.append(measure.floor(reference, ALL) ** 2)
    expected = math.sqrt(2 * passes / (passes - 1) / PIXELS) * 0.1**2 * TINT / passes
    assert np.mean(floors) == pytest.approx(expected, rel=0.05)
    assert abs(np.mean(trials)) < 4 * expected / math.sqrt(200)
    assert np.std(trials) == pytest.approx(expected, rel=0.2)


def test_bias_is_told_from_variance() -> None:
    """bias 0.02, sigma 0.05, five pictures: both within four of the standard errors of the module's formula."""
    generator = np.random.Generator(np.random.PCG64(3))
    reference, method = noisy(generator, 16, 0.05), noisy(generator, 5, 0.05, bias=0.02)
    found = measure.errors(method, reference, ALL, sampled=True)
    d, u, v = 0.02**2, 0.05**2 / 5, 0.05**2 / 16
    error = TINT * math.sqrt((4 * d * (u + v) + 2 * (u + v) ** 2 + 2 * u**2 / 4 + 2 * v**2 / 15) / PIXELS)
    assert found.bias is not None
    assert found.bias.value is not None
    assert abs(found.bias.value**2 - d * TINT) < 4 * error
    # The variance's standard error: sigma^2 sqrt(2 / 4) a pixel.
    assert found.sigma is not None
    assert abs(found.sigma**2 - 0.05**2 * TINT) < 4 * TINT * 0.05**2 * math.sqrt(0.5 / PIXELS)
    assert found.rmse.value == pytest.approx(math.sqrt(found.bias.value**2 + found.sigma**2), rel=1e-12)


def test_the_standard_error_is_the_scatter_over_trials() -> None:
    """100 trials: their deviation is known to 1 / sqrt(200) = 7%; three of those."""
    generator = np.random.Generator(np.random.PCG64(4))
    means, errors = [], []
    for _ in range(100):
        reference, method = noisy(generator, 6, 0.1), noisy(generator, 3, 0.15, bias=0.05)
        square = measure._bias(method, reference, ALL, None, True)
        means.append(square.mean)
        errors.append(square.error)
    assert np.std(means) == pytest.approx(np.mean(errors), rel=0.21)
    assert abs(np.mean(means) - 0.05**2 * TINT) < 4 * np.mean(errors) / 10


def test_what_the_reference_does_not_resolve_is_a_bound() -> None:
    """A true error under five floors is never a value, and the bound holds it."""
    generator = np.random.Generator(np.random.PCG64(5))
    for bias in (0.0, 0.003):
        reference = noisy(generator, 8, 0.1)
        assert bias * math.sqrt(TINT) < measure.FIFTH * measure.floor(reference, ALL)
        found = measure.errors(noisy(generator, 1, 0.0, bias), reference, ALL, sampled=False)
        assert found.rmse.value is None
        assert bias * math.sqrt(TINT) < found.rmse.at_most < measure.noise(reference, ALL)


def test_no_error_is_given_against_one_pass() -> None:
    generator = np.random.Generator(np.random.PCG64(6))
    found = measure.errors(noisy(generator, 1, 0.0), noisy(generator, 1, 0.1), ALL, sampled=False)
    assert found.rmse == (None, math.inf)


def test_one_picture_of_a_sampled_method_has_an_error_but_no_parts() -> None:
    generator = np.random.Generator(np.random.PCG64(7))
    found = measure.errors(noisy(generator, 1, 0.2), noisy(generator, 16, 0.05), ALL, sampled=True)
    assert (found.bias, found.sigma) == (None, None)
    assert found.rmse.value == pytest.approx(0.2 * math.sqrt(TINT), rel=4 * math.sqrt(2 / PIXELS))


def test_mrse_of_a_relative_error() -> None:
    """A tenth too bright everywhere: MRSE 0.01, less what EPSILON takes: R^2 / (R^2 + EPSILON mean^2), 0.5 to 1.5."""
    generator = np.random.Generator(np.random.PCG64(8))
    reference = noisy(generator, 4, 1e-6)
    method = record([reference.mean * 1.1])
    ramp = np.linspace(0.5, 1.5, PIXELS)
    expected = 0.01 * float(np.mean(ramp**2 / (ramp**2 + measure.EPSILON)))
    assert measure.errors(method, reference, ALL, sampled=False).mrse.value == pytest.approx(expected, rel=1e-3)


def test_errors_are_over_the_mask_alone() -> None:
    generator = np.random.Generator(np.random.PCG64(9))
    reference = noisy(generator, 4, 1e-4)
    image = reference.mean.copy()
    image[0] += 1.0
    mask = ALL.copy()
    mask[0] = False
    assert measure.errors(record([image]), reference, mask, sampled=False).rmse.at_most < 1e-4
    whole = measure.errors(record([image]), reference, ALL, sampled=False).rmse.value
    assert whole == pytest.approx(math.sqrt(1 / HEIGHT), rel=1e-3)


def power(samples: int, exponent: float = -0.75) -> Point:
    """Error 0.3 n^exponent, seconds 0.1 + 0.01 n."""
    return Point(samples, 0.1 + 0.01 * samples, 0.3 * samples**exponent)


CURVE = [power(n) for n in (4, 16, 64, 256)]


def test_equal_error_beyond_the_curve_is_the_power_law() -> None:
    found = equal(CURVE, 0.3 * 4096**-0.75)
    assert found.how == "extrapolated"
    assert found.samples == pytest.approx(4096)
    assert found.seconds == pytest.approx(0.1 + 40.96)
    assert found.slope == pytest.approx(-0.75)


def test_equal_error_within_the_curve() -> None:
    found = equal(CURVE, 0.3 * 32**-0.75)
    assert found.how == "measured"
    assert found.samples == pytest.approx(32)
    assert found.seconds == pytest.approx(math.sqrt((0.1 + 0.16) * (0.1 + 0.64)))


def test_equal_error_that_the_cheapest_setting_has() -> None:
    found = equal(CURVE, 0.2)
    assert (found.how, found.samples) == ("already", 4)
    assert found.seconds == pytest.approx(0.14)


def test_equal_error_that_is_never_reached() -> None:
    biased = [*CURVE[:-1], CURVE[-1]._replace(bias=0.004)]
    assert equal(biased, 0.003).how == "never"
    assert equal(biased, 0.0045).how == "extrapolated"
    flat = [Point(n, 0.01 * n, 0.02 + 1e-4 / n) for n in (4, 16, 64)]
    assert equal(flat, 0.01).how == "never"
    assert equal(CURVE[:1], 0.01).how == "never"


def test_flip() -> None:
    """Nothing for the same picture, more for a larger error; one brightness does not end the process."""
    ramp = np.linspace(0.1, 2.0, 32 * 24).reshape(24, 32, 1) * np.ones(3)
    for picture in (ramp, np.full_like(ramp, 0.5)):
        stops = exposures(picture)
        assert stops is not None
        means = [float(flip(picture, picture * factor, stops).mean()) for factor in (1.0, 1.05, 1.5)]
        assert means[0] == pytest.approx(0.0, abs=1e-6)
        assert means[0] < means[1] < means[2] <= 1.0
    assert exposures(np.zeros_like(ramp)) is None


def test_exposures_are_the_librarys_own() -> None:
    import flip_evaluator

    picture = np.random.Generator(np.random.PCG64(2)).random((24, 32, 3)).astype(np.float32) ** 3
    _, _, told = flip_evaluator.evaluate(picture, picture, "HDR", False, False, False, {})
    stops = exposures(picture.astype(np.float64))
    assert stops is not None
    assert stops[0] == pytest.approx(told["startExposure"], abs=1e-3)
    assert stops[1] == pytest.approx(told["stopExposure"], abs=2e-2)  # the median of an even number is its own affair
    assert stops[2] == told["numExposures"]
