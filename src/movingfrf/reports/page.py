"""The page that every report is: its parts, and the one file they are put into."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from movingfrf.reports.figures import Illustration
from movingfrf.reports.tables import Setting, Table


class Answer(NamedTuple):
    """What is asked, and what comes out."""

    asks: str
    said: str


def page(
    *,
    title: str,
    version: str,
    summary: str,
    settings: Sequence[Setting],
    findings: Sequence[str],
    no_findings: str,
    tables: Sequence[Table],
    figures: Sequence[Illustration],
    method: Sequence[str],
    scenario: str,
    measures: str = "Measures",
    answers: Sequence[Answer] = (),
) -> str:
    """Put a page together.

    Parameters
    ----------
    title : str
        Title of the page.
    version : str
        Version of the package that computed what is shown.
    summary : str
        What this is about, in a sentence or two.
    settings : sequence of Setting
        What was set.
    findings : sequence of str
        Sentences about the validity of the result.
    no_findings : str
        What is said if there are none.
    tables : sequence of Table
        Numbers.
    figures : sequence of Illustration
        Figures.
    method : sequence of str
        How it was computed, and what is assumed.
    scenario : str
        Text of the scenario.
    measures : str
        Heading of the tables.
    answers : sequence of Answer
        What the page says above all.

    Returns
    -------
    str
        One HTML page without references to anything outside it. Equal input gives equal text.
    """
    return rendered(
        "report.html.j2",
        title=title,
        version=version,
        summary=summary,
        settings=settings,
        findings=findings,
        no_findings=no_findings,
        tables=tables,
        figures=figures,
        method=method,
        scenario=scenario,
        measures=measures,
        answers=answers,
    )


def rendered(template: str, **values: object) -> str:
    """Fill in one of the package's templates.

    Parameters
    ----------
    template : str
        Name of its file.
    **values : object
        What the template asks for.

    Returns
    -------
    str
        The page.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("movingfrf", "reports/templates"),
        autoescape=True,
        undefined=StrictUndefined,
        keep_trailing_newline=True,
    )
    return environment.get_template(template).render(**values)
