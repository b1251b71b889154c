"""Settings come from the environment."""

from __future__ import annotations

from pathlib import Path

import pytest

from service.settings import Settings


def test_defaults() -> None:
    assert Settings.from_environment({}) == Settings()


def test_environment() -> None:
    settings = Settings.from_environment(
        {
            "INTAGLIO_RENDERS": "3",
            "INTAGLIO_TIME_LIMIT": "1.5",
            "INTAGLIO_WARM_UP": "0",
            "INTAGLIO_ORIGINS": "https://a.example, https://b.example",
            "INTAGLIO_PAGE": "/srv/page",
        }
    )
    assert settings.renders == 3
    assert settings.time_limit == 1.5
    assert settings.warm_up is False
    assert settings.origins == ("https://a.example", "https://b.example")
    assert settings.page == Path("/srv/page")


@pytest.mark.parametrize(
    ("name", "value"),
    [("RENDERS", "0"), ("RENDERS", "many"), ("TIME_LIMIT", "nan"), ("TIME_LIMIT", "inf"), ("WARM_UP", "maybe")],
)
def test_wrong_value_names_the_variable(name: str, value: str) -> None:
    with pytest.raises(ValueError, match=f"INTAGLIO_{name}: expected"):
        Settings.from_environment({f"INTAGLIO_{name}": value})
