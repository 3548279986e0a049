"""Alembic's environment: runs migrations on the connection it is given, else on the address of `alembic.ini` or -x."""

from alembic import context
from sqlalchemy import Connection, create_engine

from app.tables import Base


def _run(connection: Connection) -> None:
    context.configure(
        connection=connection,
        target_metadata=Base.metadata,
        render_as_batch=connection.dialect.name == "sqlite",
        compare_type=True,
    )
    with context.begin_transaction():
        context.run_migrations()


def _run_on_address() -> None:
    address = context.get_x_argument(as_dictionary=True).get("url") or context.config.get_main_option("sqlalchemy.url")
    if not address:
        raise SystemExit("name the database: alembic -x url=postgresql+psycopg://... <command>")
    with create_engine(address).begin() as connection:
        _run(connection)


_given = context.config.attributes.get("connection")
if _given is None:
    _run_on_address()
else:
    _run(_given)
