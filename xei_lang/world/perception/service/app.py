"""The HTTP face of the pose service: routes of the contract over a desk, behind a gate."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TypeVar

from fastapi import FastAPI, Request, Response
from pydantic import BaseModel, ValidationError
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp

from xei_lang.world.perception.contract import (
    HealthModel,
    ModelsModel,
    ObjectsModel,
    PoseRequestModel,
    PoseResponseModel,
    ProblemModel,
    PutObjectModel,
)
from xei_lang.world.perception.service.backend import Unable
from xei_lang.world.perception.service.gate import Gate, GateLimits
from xei_lang.world.perception.service.handle import Desk

_Model = TypeVar("_Model", bound=BaseModel)
_Found = TypeVar("_Found", bound=BaseModel | Unable)
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,99}")


def pose_app(desk: Desk, token: str | None, limits: GateLimits) -> ASGIApp:
    """The service as an ASGI app. A token, where there is one, is asked for on every route."""
    app = FastAPI(title="xei pose service", version="1", docs_url=None, redoc_url=None)

    @app.get("/health", response_model=HealthModel)
    async def health() -> Response:
        return await _answered(desk.health)

    @app.get("/models", response_model=ModelsModel)
    async def models() -> Response:
        return await _answered(desk.models)

    @app.get("/objects", response_model=ObjectsModel)
    async def objects() -> Response:
        return await _answered(desk.objects)

    @app.put("/objects/{name}", response_model=ObjectsModel, openapi_extra=_takes(PutObjectModel))
    async def put_object(name: str, request: Request) -> Response:
        body = await request.body()
        if not _NAME.fullmatch(name):
            return _problem(Unable(422, "an object's name has letters, digits and _ only"))
        return await _answered(lambda: _done(PutObjectModel, body, lambda model: desk.put(name, model)))

    @app.post("/v1/poses", response_model=PoseResponseModel, openapi_extra=_takes(PoseRequestModel))
    async def poses(request: Request) -> Response:
        body = await request.body()
        return await _answered(lambda: _done(PoseRequestModel, body, desk.poses))

    @app.exception_handler(HTTPException)
    async def refused(_: Request, error: HTTPException) -> Response:
        return _problem(Unable(error.status_code, str(error.detail)))

    @app.exception_handler(Exception)
    async def failed(_: Request, error: Exception) -> Response:
        return _problem(Unable(500, f"a fault of the service: {type(error).__name__}"))

    # What decorators have registered is not used by name.
    _ = (health, models, objects, put_object, poses, refused, failed)
    return Gate(app, token, limits)


async def _answered(work: Callable[[], BaseModel | Unable]) -> Response:
    found = await run_in_threadpool(work)
    if isinstance(found, Unable):
        return _problem(found)
    return Response(found.model_dump_json(), media_type="application/json")


def _problem(said: Unable) -> Response:
    body = ProblemModel(error=said.message[:2000]).model_dump_json()
    return Response(body, status_code=said.status, media_type="application/json")


def _done(form: type[_Model], body: bytes, work: Callable[[_Model], _Found]) -> _Found | Unable:
    """What comes of a body. What is wrong with it is said without the input: that may be pictures."""
    try:
        model = form.model_validate_json(body)
    except ValidationError as error:
        first = error.errors(include_input=False, include_url=False)[0]
        place = ".".join(str(part) for part in first["loc"])[:200]
        return Unable(422, f"{place or 'body'}: {first['msg'][:300]}")
    return work(model)


def _takes(form: type[BaseModel]) -> dict[str, object]:
    content = {"application/json": {"schema": form.model_json_schema()}}
    return {"requestBody": {"required": True, "content": content}}
