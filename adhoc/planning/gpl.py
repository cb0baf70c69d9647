"""The GPL-LLM baseline: candidates made and scored by what the teammates are predicted to do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from adhoc.core.errors import ConfigurationError, ReplyError
from adhoc.core.plans import Candidate, Context, Prediction
from adhoc.llm.model import LanguageModel
from adhoc.planning.inquiry import Inquiry
from adhoc.planning.interfaces import Evaluator, SubTaskGenerator
from adhoc.planning.legality import Legal, refusal_by
from adhoc.prompting.library import PromptLibrary
from adhoc.prompting.reply_forms import predictions_form, scores_form, sub_tasks_form
from adhoc.prompting.stage import StageInput


class GPLGenerator(SubTaskGenerator):
    """Predicts every teammate's next sub-task and sub-skill, then proposes sub-tasks (two calls).

    The order is the paper's (section Ad hoc Agent Policy): predict, generate, score. The predictions are in
    the prompt that asks for sub-tasks, and go along with the candidates to `GPLEvaluator`.

    Args:
        model: The language model.
        n: How many sub-tasks to ask for.
        predict_template: Name of the template that asks for predictions.
        template: Name of the template that asks for sub-tasks.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `Inquiry`.
        max_tokens: The longest reply of either call.
        legal: See `LLMGenerator`; what the teammates are able to do is not checked.

    Raises:
        ConfigurationError: n is below 1.
    """

    def __init__(
        self,
        model: LanguageModel,
        n: int = 3,
        predict_template: str = "gpl_predict",
        template: str = "gpl_generate",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 1024,
        legal: Legal | None = None,
    ) -> None:
        if n < 1:
            raise ConfigurationError(f"GPLGenerator: n is {n}, it must be at least 1")
        self._count, self._legal = n, legal
        self._predict = Inquiry(model, predict_template, prompts, repairs, max_tokens)
        self._generate = Inquiry(model, template, prompts, repairs, max_tokens)

    def generate(self, context: Context) -> Sequence[Candidate]:
        """See `SubTaskGenerator`. At most n candidates, each with all predictions.

        Without any known teammate nothing is predicted. Nor is anything where the model gives no usable
        predictions: the robot must do something all the same, and the invalid replies are counted.
        """
        predictions = self._predictions(context) if context.teammates else ()
        refusal = refusal_by(self._legal, context.task.sub_tasks, context.capability)
        proposed: tuple[Candidate, ...] = self._generate.ask(
            context,
            StageInput(count=self._count, predictions=predictions),
            lambda prompt: sub_tasks_form(prompt, context, self._count, refusal),
        )
        return tuple(replace(candidate, predictions=predictions) for candidate in proposed)

    def _predictions(self, context: Context) -> tuple[Prediction, ...]:
        try:
            predictions: tuple[Prediction, ...] = self._predict.ask(
                context, StageInput(), lambda prompt: predictions_form(prompt, context)
            )
        except ReplyError:
            return ()
        return predictions


class GPLEvaluator(Evaluator):
    """Scores the candidates by the predictions that they carry; after another generator, by none.

    Args:
        model: The language model.
        template: Name of the template that asks for scores from 0 to 10.
        prompts: Where templates come from; the shipped ones by default.
        repairs: See `Inquiry`.
        max_tokens: The longest reply.
    """

    def __init__(
        self,
        model: LanguageModel,
        template: str = "gpl_score",
        prompts: PromptLibrary | None = None,
        repairs: int = 1,
        max_tokens: int = 1024,
    ) -> None:
        self._inquiry = Inquiry(model, template, prompts, repairs, max_tokens)

    def rank(self, context: Context, candidates: Sequence[Candidate]) -> Sequence[Candidate]:
        """See `Evaluator`. By score, ties in the order of generation; those without a score come last."""
        predictions = dict.fromkeys(it for candidate in candidates for it in candidate.predictions)
        stage = StageInput(candidates=tuple(candidates), predictions=tuple(predictions))
        scores = self._inquiry.ask(context, stage, lambda prompt: scores_form(prompt, len(candidates)))
        scored = [replace(candidate, score=score) for candidate, score in zip(candidates, scores)]
        return tuple(sorted(scored, key=lambda it: (it.score is None, -(it.score or 0.0))))
