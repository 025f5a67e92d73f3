"""Spreadsheets written by hand: what is in them is the standards', not a library's."""

import zipfile
from xml.sax.saxutils import escape


def xlsx(file, sheets):
    """Write sheets, each a list of rows of numbers and texts, as Excel does."""
    kinds = "http://schemas.openxmlformats.org/"
    main_ns, package = f"{kinds}spreadsheetml/2006/main", f"{kinds}package/2006/"
    office = f"{kinds}officeDocument/2006/relationships"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as parts:
        parts.writestr(
            "[Content_Types].xml",
            f'<Types xmlns="{package}content-types"><Default Extension="xml" ContentType="application/xml"/>'
            '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
            "</Types>",
        )
        parts.writestr(
            "_rels/.rels",
            f'<Relationships xmlns="{package}relationships"><Relationship Id="r" Type="{office}/officeDocument" '
            'Target="xl/workbook.xml"/></Relationships>',
        )
        names = "".join(f'<sheet name="{escape(s)}" sheetId="{n}" r:id="r{n}"/>' for n, s in enumerate(sheets, 1))
        parts.writestr(
            "xl/workbook.xml",
            f'<workbook xmlns="{main_ns}" xmlns:r="{office}"><sheets>{names}</sheets></workbook>',
        )
        links = "".join(
            f'<Relationship Id="r{n}" Type="{office}/worksheet" Target="worksheets/s{n}.xml"/>'
            for n in range(1, len(sheets) + 1)
        )
        parts.writestr(
            "xl/_rels/workbook.xml.rels", f'<Relationships xmlns="{package}relationships">{links}</Relationships>'
        )
        for n, rows in enumerate(sheets.values(), 1):
            cells = "".join(
                f'<row r="{at}">' + "".join(_cell(f"{chr(65 + c)}{at}", v) for c, v in enumerate(row)) + "</row>"
                for at, row in enumerate(rows, 1)
            )
            parts.writestr(
                f"xl/worksheets/s{n}.xml",
                f'<worksheet xmlns="{main_ns}"><sheetData>{cells}</sheetData></worksheet>',
            )
    return file


def _cell(place, value):
    if value == "":
        return ""
    if isinstance(value, str):
        return f'<c r="{place}" t="inlineStr"><is><t>{escape(value)}</t></is></c>'
    return f'<c r="{place}"><v>{value!r}</v></c>'


def ods(file, sheets):
    """Write sheets as LibreOffice does."""
    names = "urn:oasis:names:tc:opendocument:xmlns:"
    tables = ""
    for name, rows in sheets.items():
        body = ""
        for row in rows:
            cells = "".join(
                f'<table:table-cell office:value-type="string"><text:p>{escape(v)}</text:p></table:table-cell>'
                if isinstance(v, str)
                else f'<table:table-cell office:value-type="float" office:value="{v!r}"/>'
                for v in row
            )
            body += f"<table:table-row>{cells or '<table:table-cell/>'}</table:table-row>"
        tables += f'<table:table table:name="{escape(name)}">{body}</table:table>'
    with zipfile.ZipFile(file, "w") as parts:
        parts.writestr("mimetype", "application/vnd.oasis.opendocument.spreadsheet")
        parts.writestr(
            "content.xml",
            f'<office:document-content xmlns:office="{names}office:1.0" xmlns:table="{names}table:1.0" '
            f'xmlns:text="{names}text:1.0" office:version="1.3"><office:body><office:spreadsheet>{tables}'
            "</office:spreadsheet></office:body></office:document-content>",
        )
        parts.writestr(
            "META-INF/manifest.xml",
            f'<manifest:manifest xmlns:manifest="{names}manifest:1.0"><manifest:file-entry manifest:full-path="/" '
            'manifest:media-type="application/vnd.oasis.opendocument.spreadsheet"/></manifest:manifest>',
        )
    return file
