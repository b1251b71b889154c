"""The service keeps what its OpenAPI document promises, whatever it is sent."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, given, settings
from schemathesis.checks import not_a_server_error
from schemathesis.generation import GenerationMode
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from service.app import create

from .conftest import SETTINGS, FakeRenderer, open_server

CHECKS = [not_a_server_error, content_type_conformance, response_schema_conformance, status_code_conformance]
OPERATIONS = sorted((method, path) for path, item in create(SETTINGS).openapi()["paths"].items() for method in item)
# Of what a GET takes, nothing can be wrong.
TRIALS = [(GenerationMode.POSITIVE, *operation) for operation in OPERATIONS] + [
    (GenerationMode.NEGATIVE, *operation) for operation in OPERATIONS if operation[0] == "post"
]


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with open_server() as opened:
        yield opened


@pytest.mark.parametrize(("mode", "method", "path"), TRIALS)
def test_promises(address: str, fake: FakeRenderer, mode: GenerationMode, method: str, path: str) -> None:
    operation = schemathesis.openapi.from_url(f"{address}/api/openapi.json")[path][method.upper()]

    @settings(max_examples=15, deadline=None, derandomize=True, database=None, suppress_health_check=list(HealthCheck))
    @given(operation.as_strategy(generation_mode=mode))
    def run(case: Any) -> None:
        case.call_and_validate(checks=CHECKS)

    run()
