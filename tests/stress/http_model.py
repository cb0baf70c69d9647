"""The smallest client of an OpenAI-compatible endpoint: importing it costs nothing, unlike litellm, so that
300 runs can be started and killed in minutes. The address comes from the environment and not from the
configuration, so that runs against several providers are runs of one configuration."""

from __future__ import annotations

import http.client
import json
import os
from urllib.parse import urlsplit

from adhoc.core.errors import ModelBusy
from adhoc.llm.model import LanguageModel, LMRequest, LMResponse, Usage

URL = "STRESS_PROVIDER_URL"
TIMEOUT_S = 30.0


class HttpModel(LanguageModel):
    """Asks the provider whose address is in the environment."""

    @property
    def name(self) -> str:
        return "small"

    def complete(self, request: LMRequest) -> LMResponse:
        url = urlsplit(os.environ[URL])
        messages = [{"role": it.role, "content": it.content} for it in request.messages]
        body = json.dumps({"model": self.name, "messages": messages, "max_tokens": request.max_tokens})
        connection = http.client.HTTPConnection(url.hostname or "", url.port, timeout=TIMEOUT_S)
        try:
            connection.request("POST", f"{url.path}/chat/completions", body)
            reply = connection.getresponse()
            content = json.loads(reply.read())
        except OSError as error:
            raise ModelBusy(f"the provider cannot be reached: {error}") from error
        finally:
            connection.close()
        if reply.status != 200:
            raise ModelBusy(f"the provider answers {reply.status}")
        usage = Usage(content["usage"]["prompt_tokens"], content["usage"]["completion_tokens"])
        return LMResponse(content["choices"][0]["message"]["content"], self.name, usage, raw=content)
